#pragma once

#include "Core/SharedSpan.h"
#include "Echo/FormRf.h"
#include "Image/BMode.h"
#include "Image/ScanConvert.h"
#include "Image/ScanConvertVolume.h"
#include "StageResult.h"
#include "Trace/Trace.h"

#include <cstdint>
#include <memory>
#include <utility>

namespace sono {

// What a stage leaves on the device, see Cuda/DeviceImager.h.
struct DeviceTraced;
struct DeviceRf;
struct DeviceGrey;
struct DevicePicture;

using TracedResult = StageResult<TracedLines, DeviceTraced>;
using RfResult = StageResult<RfLines, DeviceRf>;
using BModeResult = StageResult<BModeLines, DeviceGrey>;
using PlaneResult = StageResult<PlaneImage, DevicePicture>;

/// A scan-converted image: of a plane, or of the volume that a matrix scans, which is made on the host.
class ImageResult
{
public:
  ImageResult() = default;
  explicit ImageResult(PlaneResult plane)
    : plane_(std::move(plane))
  {
  }
  explicit ImageResult(VolumeImage volume)
    : volume_(std::make_shared<const VolumeImage>(std::move(volume)))
  {
  }

  bool operator==(const ImageResult& other) const { return plane_ == other.plane_ && volume_ == other.volume_; }
  bool isVolume() const { return volume_ != nullptr; }
  /// The one that it is.
  const PlaneResult& plane() const { return plane_; }
  const VolumeImage& volume() const { return *volume_; }

private:
  PlaneResult plane_;
  std::shared_ptr<const VolumeImage> volume_;
};

/// An image as it is shown, lateral fastest.
struct ScanPicture
{
  SharedSpan<std::uint8_t> grey;    ///< see greyBytes
  SharedSpan<std::uint8_t> mask;    ///< 1 inside the scanned area
  SharedSpan<std::uint16_t> labels; ///< see sliceLabels; empty where they were not wanted
};

} // namespace sono
