#pragma once

#include "Probe/ScanGeometry.h"

#include <array>

class vtkImageData;

namespace sono {

/// Size and place of an ultrasound image's pixels, whether it is flat or in the world: as its probe has them.
struct GreyLayout
{
  int width = 0;
  int height = 0;
  double pixelMm = 0.0;
  std::array<double, 2> firstMm{}; ///< lateral and axial, of the middle of the first pixel from that of the face
};

/// Throws Error for an image that is not the whole one of this geometry, and for one without greys. Of a volume without
/// a place.
GreyLayout greyLayout(vtkImageData* image, const ScanGeometry& geometry);

/// The "BMode" of an image's slices; of the image, which must outlive it. Throws Error where there is none.
class GreySlices
{
public:
  explicit GreySlices(vtkImageData* image);

  int width() const { return size_[0]; }
  int height() const { return size_[1]; }
  int count() const { return size_[2]; }
  const unsigned char* at(int slice) const { return first_ + std::ptrdiff_t(slice) * size_[0] * size_[1]; }

private:
  std::array<int, 3> size_{};
  const unsigned char* first_;
};

} // namespace sono
