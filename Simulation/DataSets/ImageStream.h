#pragma once

#include "DataSets/DataSetImager.h"

#include <functional>
#include <memory>
#include <optional>

namespace sono {

/// An image of a stream, and its number in the data set.
struct StreamedImage
{
  std::int64_t index = 0;
  DataSetImage image;
};

/// Images of a data set one after the other, for a loop that learns from them. They are made ahead by threads of the
/// stream's own, as many as suit the device (imageWorkers) and at most a few images each, while the loop does something
/// else.
///
/// On a CPU they come in the order of their numbers. Where several threads make them they come as they are made, images
/// of as many bodies as there are threads among each other; which they are, and what each of them is, stays the same.
class ImageStream
{
public:
  using Wanted = std::function<bool(std::int64_t index)>;

  /// Begins with the images of a share, or with those of them that are wanted. `workers` 0: as many as suit the device.
  /// What the imager knows of patients and bodies is shared with it. Throws Error where the share is none, or the
  /// device is a GPU that cannot be used.
  ImageStream(const DataSetImager& imager, const DataSetShare& share, const Wanted& wanted = {}, int workers = 0);
  /// Stops what is being made.
  ~ImageStream();
  ImageStream(const ImageStream&) = delete;
  ImageStream& operator=(const ImageStream&) = delete;

  /// No image is left, and none will come.
  bool hasEnded() const;
  /// One that is made by now, if any. Throws what making it has thrown, once those that were made before are taken:
  /// Error as DataSetImager.
  std::optional<StreamedImage> takeMade();

private:
  struct Queue;

  std::unique_ptr<Queue> queue_;
};

} // namespace sono
