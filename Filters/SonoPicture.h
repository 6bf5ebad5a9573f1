#pragma once

#include "Pictures/OpenExrBytes.h"
#include "Pictures/WritePicture.h"

#include <string>

class vtkDataArray;
class vtkImageData;

namespace sono {

/// The picture of a point array of an image with one slice. It sees the array, which must outlive it. Throws Error for
/// more slices, and for numbers that no picture holds.
Picture pictureOf(vtkImageData* image, vtkDataArray* array);

/// Writes a picture by the library of Pictures/WritePicture.h, which the first call loads. Throws Error when that or
/// the writing fails.
void writePicture(const std::string& path, const Picture& picture);

/// The bytes of an OpenEXR file, by the same library. From any thread. Throws as writePicture.
std::string openExrBytes(const ChannelImage& image);

} // namespace sono
