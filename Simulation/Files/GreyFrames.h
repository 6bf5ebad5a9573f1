#pragma once

#include "Core/WholeFile.h"
#include "Files/FrameTally.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace sono {

/// The pictures of a file, which come one by one and have one size.
class PictureTally : public FrameTally
{
public:
  PictureTally(const std::string& path, int width, int height, std::size_t count)
    : FrameTally(path, "picture", count)
    , width_(width)
    , height_(height)
  {
  }

  /// Throws Error for another size, too.
  void add(int width, int height);

private:
  int width_;
  int height_;
};

/// A file that is a header and pictures of 8 bits, one after the other: whole or not at all.
class GreyFrames
{
public:
  /// Throws Error naming the path where it cannot be written.
  GreyFrames(const std::string& path, const std::string& header, int width, int height, std::size_t count);

  /// Throws Error for another size, one too many, and a full disk.
  void add(const std::uint8_t* grey, int width, int height);
  /// Throws Error where pictures are missing, or the disk is full. `padding` comes behind the last.
  void finish(const std::string& padding = {});

private:
  PictureTally tally_;
  WholeFile file_;
};

/// "640 x 480 pixels".
std::string sizeText(int width, int height);

} // namespace sono
