#include "SonoFieldImage.h"

#include "Core/Progress.h"
#include "Kernel/Vec.h"
#include "SonoLineImage.h"

#include "vtkDataObject.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMatrix3x3.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

namespace sono {
namespace {

constexpr const char* arrayName = "PulseEchoWeight";

Vec3d minimaMm(const FieldGrid& grid)
{
  return { grid.lateral.minMm, grid.elevational.minMm, grid.depth.minMm };
}

Vec3d stepsMm(const FieldGrid& grid)
{
  return { grid.lateral.stepMm, grid.elevational.stepMm, grid.depth.stepMm };
}

} // namespace

void announceFieldImage(const FieldGrid& grid, vtkInformation* outInfo)
{
  const int extent[6] = { 0, grid.lateral.count - 1, 0, grid.elevational.count - 1, 0, grid.depth.count - 1 };
  const Vec3d origin = minimaMm(grid);
  const Vec3d spacing = stepsMm(grid);
  outInfo->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  outInfo->Set(vtkDataObject::ORIGIN(), &origin.x, 3);
  outInfo->Set(vtkDataObject::SPACING(), &spacing.x, 3);
  vtkDataObject::SetPointDataActiveScalarInfo(outInfo, VTK_FLOAT, 1);
}

void imageFromField(const PulseEchoField& field, vtkImageData* image)
{
  const FieldGrid& grid = field.grid();
  const Vec3d origin = minimaMm(grid);
  const Vec3d spacing = stepsMm(grid);
  image->SetDimensions(grid.lateral.count, grid.elevational.count, grid.depth.count);
  image->SetOrigin(&origin.x);
  image->SetSpacing(&spacing.x);
  image->GetPointData()->SetScalars(lineArray(arrayName, field.values()));
}

PulseEchoField fieldFromImage(vtkImageData* image)
{
  vtkDataArray* weights = image->GetPointData()->GetArray(arrayName);
  if (!weights || weights->GetNumberOfComponents() != 1)
  {
    throw Error("The input Field has no point array 'PulseEchoWeight' with one component; connect a Pulse-Echo Field "
                "or rename its array.");
  }
  if (!image->GetDirectionMatrix()->IsIdentity())
  {
    throw Error("The input Field has turned axes; give an image whose x is lateral, y elevational and z the depth.");
  }
  const auto axis = [&](int i) {
    const double stepMm = image->GetSpacing()[i];
    return FieldAxis{ image->GetOrigin()[i] + image->GetExtent()[2 * i] * stepMm, stepMm, image->GetDimensions()[i] };
  };
  const FieldGrid grid{ axis(0), axis(1), axis(2) };
  grid.validate("The input Field");
  return PulseEchoField(grid, lineValues(arrayName, image->GetPointData(), grid.size()), "The input Field");
}

} // namespace sono
