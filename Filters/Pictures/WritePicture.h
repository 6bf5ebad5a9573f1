#pragma once

#include <cstddef>
#include <string>

namespace sono {

/// Pixels for a file. The first row is the top of the picture, the first pixel of a row its left.
struct Picture
{
  enum class Number
  {
    UInt8,
    UInt16,
    Float
  };

  const void* pixels = nullptr; ///< height x width x channels numbers, without gaps
  int width = 0;
  int height = 0;
  int channels = 1; ///< 1 grey, 3 colours, 4 with opacity
  Number number = Number::UInt8;
  double pixelMm[2] = { 1.0, 1.0 }; ///< width and height of a pixel, which the file tells as pixels per cm
};

} // namespace sono

/// A function of the library that writes pictures, in the format that the path's ending names. `failure`
/// is empty then, or why nothing was written. The library is loaded when a picture is written for the first time: it
/// brings OpenImageIO, which takes most of a second to load.
extern "C" void sonoWritePicture(const std::string& path, const sono::Picture& picture, std::string& failure);
