#include "vtkSonoErrorMap.h"

#include "Simulator.h"
#include "SonoImagePlacement.h"
#include "SonoLineImage.h"
#include "SonoOutputs.h"
#include "SonoStage.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"

#include <utility>

vtkStandardNewMacro(vtkSonoErrorMap);

vtkSonoErrorMap::vtkSonoErrorMap()
{
  this->SetNumberOfOutputPorts(2);
  this->SetProgressText("Mapping the error");
}

vtkSonoErrorMap::~vtkSonoErrorMap() = default;

void vtkSonoErrorMap::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "PixelMm: " << this->PixelMm << endl;
}

int vtkSonoErrorMap::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

int vtkSonoErrorMap::RequestInformation(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    vtkFieldData* acquisition = sono::announcedFields(input[0]->GetInformationObject(0));
    const sono::ProbeField probe = sono::readProbe(acquisition);
    const sono::ImagePlacement placement = sono::placementOf(probe, sono::pixelMmOf(probe, this->PixelMm));
    placement.announce(VTK_FLOAT, output->GetInformationObject(0));
    placement.flat(probe.pose).announce(VTK_FLOAT, output->GetInformationObject(1));
    for (int port : { 0, 1 })
    {
      sono::announceFields(acquisition, output->GetInformationObject(port));
    }
  });
}

int vtkSonoErrorMap::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  return sono::requestWholeImage(input);
}

int vtkSonoErrorMap::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    vtkImageData* lines = vtkImageData::GetData(input[0]);
    const sono::ProbeField probe = sono::readProbe(lines->GetFieldData());
    const sono::LineImageLayout layout = sono::lineImageLayout(lines, probe.geometry.totalLineCount());
    sono::TracedResult traced = sono::tracedHandleOf(lines);
    if (!traced)
    {
      const std::size_t count = std::size_t(layout.lineCount) * layout.sampleCount;
      sono::TracedLines values = sono::rangeArraysOf(lines, layout.lineCount);
      values.binCount = layout.sampleCount;
      values.binMm = layout.sampleMm;
      values.intensity = sono::lineValues("Intensity", lines->GetPointData(), count);
      values.standardError = sono::lineValues("StandardError", lines->GetPointData(), count);
      traced = sono::TracedResult(std::move(values));
    }
    const sono::ImageResult map = sono::Simulator().errorMap(
      probe.geometry, traced, probe.preview, sono::pixelMmOf(probe, this->PixelMm), sono::progressOf(this));
    vtkImageData* world = vtkImageData::GetData(output, 0);
    vtkImageData* flat = vtkImageData::GetData(output, 1);
    sono::placeImage(map, probe.pose, world);
    sono::placeFlat(map, probe.pose, world, flat);
    const auto arrays = sono::errorArrays(map);
    world->GetPointData()->ShallowCopy(arrays);
    sono::fillFlat(world, flat);
  });
}
