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

/// A point array of an image's slices; of the image, which must outlive it.
template<class Value>
class PictureSlices
{
public:
  int width() const { return size_[0]; }
  int height() const { return size_[1]; }
  int count() const { return size_[2]; }
  const Value* at(int slice) const { return first_ + std::ptrdiff_t(slice) * size_[0] * size_[1]; }

protected:
  PictureSlices() = default;

  std::array<int, 3> size_{};
  const Value* first_ = nullptr;
};

/// The "BMode" of an image's slices. Throws Error where there is none.
class GreySlices : public PictureSlices<unsigned char>
{
public:
  explicit GreySlices(vtkImageData* image);
};

/// Their "Labels". Throws Error where there are none.
class LabelSlices : public PictureSlices<unsigned short>
{
public:
  explicit LabelSlices(vtkImageData* image);
};

} // namespace sono
