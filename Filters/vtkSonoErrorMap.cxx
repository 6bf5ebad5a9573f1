#include "vtkSonoErrorMap.h"

#include "SonoImagePlacement.h"
#include "SonoLineImage.h"
#include "SonoStage.h"

#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <limits>
#include <vector>

vtkStandardNewMacro(vtkSonoErrorMap);

namespace {

/// Percent of the intensity, by line and bin.
std::vector<float> errorPercent(const std::vector<float>& intensity, const std::vector<float>& standardError)
{
  std::vector<float> percent(intensity.size());
  for (std::size_t i = 0; i < percent.size(); ++i)
  {
    percent[i] = intensity[i] > 0.0f ? std::min(100.0f, 100.0f * standardError[i] / intensity[i]) : 100.0f;
  }
  return percent;
}

/// Scan conversion takes the first sample to lie at depth 0, but a bin's value stands for its middle. So the bins are
/// sampled twice as finely: the odd samples are the bins, the even ones lie between two.
std::vector<float> betweenBins(const std::vector<float>& bins, int lineCount, int binCount)
{
  std::vector<float> samples(2 * bins.size());
  for (int line = 0; line < lineCount; ++line)
  {
    const float* from = bins.data() + std::size_t(line) * binCount;
    float* to = samples.data() + std::size_t(line) * 2 * binCount;
    for (int bin = 0; bin < binCount; ++bin)
    {
      to[2 * bin] = 0.5f * (from[std::max(0, bin - 1)] + from[bin]);
      to[2 * bin + 1] = from[bin];
    }
  }
  return samples;
}

/// The map of nothing, as large as the layout.
template<class Converted>
Converted unknown(Converted layout, std::size_t count)
{
  layout.value.assign(count, 0.0f);
  layout.mask.assign(count, 0);
  return layout;
}

/// A plane or a volume.
template<class Converted>
void fillMap(const Converted& converted, const sono::ProbePose& pose, vtkImageData* image, vtkImageData* flat)
{
  const auto count = static_cast<vtkIdType>(converted.value.size());
  vtkNew<vtkFloatArray> percent;
  percent->SetName("ErrorPercent");
  percent->SetNumberOfValues(count);
  vtkNew<vtkUnsignedCharArray> mask;
  mask->SetName("Mask");
  mask->SetNumberOfValues(count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    const bool inside = converted.mask[static_cast<std::size_t>(i)] != 0;
    percent->SetValue(i,
                      inside ? converted.value[static_cast<std::size_t>(i)] : std::numeric_limits<float>::quiet_NaN());
    mask->SetValue(i, inside);
  }
  const sono::ImagePlacement placement(converted, pose);
  placement.place(image);
  image->GetPointData()->SetScalars(percent);
  image->GetPointData()->AddArray(mask);
  flat->ShallowCopy(image);
  placement.flat(pose).place(flat);
}

} // namespace

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
    const double pixelMm = sono::pixelMmOf(probe, this->PixelMm);
    const auto fill = [&](const auto& converted) {
      fillMap(converted, probe.pose, vtkImageData::GetData(output, 0), vtkImageData::GetData(output, 1));
    };
    const bool isVolume = probe.geometry.isVolume();
    if (probe.preview && isVolume)
    {
      const sono::VolumeImage image = sono::volumeImageLayout(probe.geometry, pixelMm);
      return fill(unknown(image, image.voxelCount()));
    }
    if (probe.preview)
    {
      const sono::PlaneImage image = sono::planeImageLayout(probe.geometry, pixelMm);
      return fill(unknown(image, std::size_t(image.width) * image.height));
    }
    const std::size_t count = std::size_t(layout.lineCount) * layout.sampleCount;
    const std::vector<float> samples =
      betweenBins(errorPercent(sono::lineValues("Intensity", lines->GetPointData(), count),
                               sono::lineValues("StandardError", lines->GetPointData(), count)),
                  layout.lineCount, layout.sampleCount);
    const int sampleCount = 2 * layout.sampleCount;
    const double sampleMm = layout.sampleMm / 2.0;
    if (isVolume)
    {
      fill(sono::scanConvertVolume(probe.geometry, samples, sampleCount, sampleMm, pixelMm, sono::progressOf(this)));
    }
    else
    {
      fill(sono::scanConvert(probe.geometry, samples, sampleCount, sampleMm, pixelMm));
    }
  });
}
