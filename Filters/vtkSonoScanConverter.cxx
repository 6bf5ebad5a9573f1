#include "vtkSonoScanConverter.h"

#include "Image/ScanConvert.h"
#include "SonoLineImage.h"
#include "SonoProbeField.h"
#include "SonoStage.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>

vtkStandardNewMacro(vtkSonoScanConverter);

namespace {

/// Origin and direction matrix (row-major) that put the plane's image into the world.
struct Placement
{
  Placement(const sono::PlaneImage& plane, const sono::ProbePose& pose)
  {
    origin = pose.positionMm + plane.lateralMinMm * pose.lateral + plane.axialMinMm * pose.axial;
    const sono::Vec3d columns[3] = { pose.lateral, pose.axial, glm::cross(pose.axial, pose.lateral) };
    for (int row = 0; row < 3; ++row)
    {
      for (int column = 0; column < 3; ++column)
      {
        direction[3 * row + column] = columns[column][row];
      }
    }
  }

  sono::Vec3d origin;
  std::array<double, 9> direction{};
};

} // namespace

vtkSonoScanConverter::vtkSonoScanConverter() = default;
vtkSonoScanConverter::~vtkSonoScanConverter() = default;

void vtkSonoScanConverter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "PixelMm: " << this->PixelMm << endl;
}

int vtkSonoScanConverter::RequestInformation(vtkInformation*, vtkInformationVector** input,
                                             vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    vtkFieldData* acquisition = sono::announcedFields(input[0]->GetInformationObject(0));
    const sono::ProbeField probe = sono::readProbe(acquisition);
    // Converting one sample a line is cheap and tells the size by the one rule that there is
    // for it.
    const std::vector<float> blank(std::size_t(probe.geometry.totalLineCount()), 0.0f);
    const sono::PlaneImage plane = sono::scanConvert(probe.geometry, blank, 1, probe.geometry.depthMm, this->PixelMm);
    const Placement placement(plane, probe.pose);

    const int extent[6] = { 0, plane.width - 1, 0, plane.height - 1, 0, 0 };
    const double spacing[3] = { this->PixelMm, this->PixelMm, this->PixelMm };
    vtkInformation* outInfo = output->GetInformationObject(0);
    outInfo->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
    outInfo->Set(vtkDataObject::ORIGIN(), &placement.origin.x, 3);
    outInfo->Set(vtkDataObject::SPACING(), spacing, 3);
    outInfo->Set(vtkDataObject::DIRECTION(), placement.direction.data(), 9);
    vtkDataObject::SetPointDataActiveScalarInfo(outInfo, VTK_UNSIGNED_CHAR, 1);
    sono::announceFields(acquisition, outInfo);
  });
}

int vtkSonoScanConverter::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  return sono::requestWholeImage(input);
}

int vtkSonoScanConverter::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    vtkImageData* lines = vtkImageData::GetData(input[0]);
    const sono::ProbeField probe = sono::readProbe(lines->GetFieldData());
    const sono::LineImageLayout layout = sono::lineImageLayout(lines, probe.geometry.totalLineCount());
    const std::vector<float> grey =
      sono::lineValues("BMode", lines->GetPointData(), std::size_t(layout.lineCount) * layout.sampleCount);
    const sono::PlaneImage plane =
      sono::scanConvert(probe.geometry, grey, layout.sampleCount, layout.sampleMm, this->PixelMm);

    const Placement placement(plane, probe.pose);
    vtkImageData* image = vtkImageData::GetData(output);
    image->SetDimensions(plane.width, plane.height, 1);
    image->SetOrigin(&placement.origin.x);
    image->SetSpacing(plane.pixelMm, plane.pixelMm, plane.pixelMm);
    image->SetDirectionMatrix(placement.direction.data());

    vtkNew<vtkUnsignedCharArray> pixels;
    pixels->SetName("BMode");
    pixels->SetNumberOfValues(static_cast<vtkIdType>(plane.value.size()));
    std::transform(plane.value.begin(), plane.value.end(), pixels->GetPointer(0), [](float value) {
      return static_cast<unsigned char>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
    });
    vtkNew<vtkUnsignedCharArray> mask;
    mask->SetName("Mask");
    mask->SetNumberOfValues(static_cast<vtkIdType>(plane.mask.size()));
    std::copy(plane.mask.begin(), plane.mask.end(), mask->GetPointer(0));
    image->GetPointData()->SetScalars(pixels);
    image->GetPointData()->AddArray(mask);
  });
}
