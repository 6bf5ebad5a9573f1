#include "SonoDisplay.h"

#include "Core/Progress.h"
#include "SameSettings.h"

#include "vtkDataObject.h"
#include "vtkFloatArray.h"
#include "vtkImageAnisotropicDiffusion2D.h"
#include "vtkImageAnisotropicDiffusion3D.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <algorithm>
#include <utility>

namespace sono {
namespace {

bool isOff(const DisplaySettings& s)
{
  return s.persistence == 0.0 && s.speckleReduction == 0;
}

template<class Filter>
void diffuse(vtkImageData* image, const DisplaySettings& settings)
{
  vtkNew<Filter> filter;
  filter->SetInputData(image);
  filter->SetNumberOfIterations(settings.speckleReduction);
  filter->SetDiffusionThreshold(settings.speckleThreshold);
  filter->SetDiffusionFactor(1.0);
  filter->Update();
  image->ShallowCopy(filter->GetOutput());
}

/// Levels from 0 to 1; what is not in the mask neither gives nor takes.
void reduceSpeckle(std::vector<float>& level, const std::vector<std::uint8_t>& mask, const Vec3i& size,
                   const DisplaySettings& settings)
{
  constexpr float farAway = -1e4f;
  vtkNew<vtkFloatArray> grey;
  grey->SetNumberOfValues(static_cast<vtkIdType>(level.size()));
  float* values = grey->GetPointer(0);
  for (std::size_t i = 0; i < level.size(); ++i)
  {
    values[i] = mask[i] ? 255.0f * level[i] : farAway;
  }
  vtkNew<vtkImageData> image;
  image->SetDimensions(size.x, size.y, size.z);
  image->GetPointData()->SetScalars(grey);
  size.z > 1 ? diffuse<vtkImageAnisotropicDiffusion3D>(image, settings)
             : diffuse<vtkImageAnisotropicDiffusion2D>(image, settings);
  const float* reduced = static_cast<const float*>(image->GetScalarPointer());
  for (std::size_t i = 0; i < level.size(); ++i)
  {
    level[i] = mask[i] ? std::clamp(reduced[i] / 255.0f, 0.0f, 1.0f) : level[i];
  }
}

} // namespace

std::optional<double> timeOf(vtkDataObject* data)
{
  vtkInformation* info = data ? data->GetInformation() : nullptr;
  return info && info->Has(vtkDataObject::DATA_TIME_STEP()) ? std::optional(info->Get(vtkDataObject::DATA_TIME_STEP()))
                                                            : std::nullopt;
}

template<class Image>
Image Display::process(Image image, const Vec3i& size, bool follows, const DisplaySettings& settings)
{
  if (follows && average_.size() == image.value.size())
  {
    const auto before = float(settings.persistence);
    for (std::size_t i = 0; i < image.value.size(); ++i)
    {
      image.value[i] += before * (average_[i] - image.value[i]);
    }
  }
  average_ = settings.persistence > 0.0 ? image.value : std::vector<float>();
  if (settings.speckleReduction > 0)
  {
    reduceSpeckle(image.value, image.mask, size, settings);
  }
  return image;
}

const ImageResult& Display::show(const ImageResult& image, const ProbeField& probe, std::optional<double> time,
                                 const DisplaySettings& settings)
{
  requireInRange(settings);
  const bool isSameImage = image == from_;
  const bool isSameDisplay = same(settings, settings_);
  if (isSameImage && isSameDisplay)
  {
    return shown_;
  }
  const bool follows = !isSameImage && isSameDisplay && same(probe.geometry, probe_.geometry) &&
                       same(probe.pose, probe_.pose) && time && time_ && *time != *time_;
  from_ = ImageResult(); // stays so when it fails
  if (isOff(settings))
  {
    shown_ = image;
    average_.clear();
  }
  else if (image.isVolume())
  {
    shown_ = ImageResult(process(image.volume(), image.volume().size, follows, settings));
  }
  else
  {
    const PlaneImage& plane = image.plane().host();
    shown_ = ImageResult(PlaneResult(process(plane, { plane.width, plane.height, 1 }, follows, settings)));
  }
  from_ = image;
  probe_ = probe;
  time_ = time;
  settings_ = settings;
  return shown_;
}

} // namespace sono
