#pragma once

#include "Image/DisplaySettings.h"
#include "ImageResult.h"
#include "SonoProbeField.h"

#include <optional>
#include <vector>

class vtkDataObject;

namespace sono {

/// When the data were, where they have a time.
std::optional<double> timeOf(vtkDataObject* data);

/// Persistence and speckle reduction of the images of one output.
class Display
{
public:
  /// What is shown of an image of this probe and time; the image itself where nothing is asked for. Asked again with
  /// the same, it gives the same. An image of another time and otherwise of the same probe and settings follows the one
  /// before; any other is the first. Throws Error for settings out of range.
  const ImageResult& show(const ImageResult& image, const ProbeField& probe, std::optional<double> time,
                          const DisplaySettings& settings);

private:
  template<class Image>
  Image process(Image image, const Vec3i& size, bool follows, const DisplaySettings& settings);

  ImageResult from_;
  ImageResult shown_;
  ProbeField probe_;
  std::optional<double> time_;
  DisplaySettings settings_;
  std::vector<float> average_;
};

} // namespace sono
