#include "Files/GreyFrames.h"

#include <ostream>

namespace sono {

std::string sizeText(int width, int height)
{
  return std::to_string(width) + " x " + std::to_string(height) + " pixels";
}

void PictureTally::add(int width, int height)
{
  if (width != width_ || height != height_)
  {
    refuse(name() + " has " + sizeText(width, height) + " and the first " + sizeText(width_, height_) +
           "; keep the probe's depth, its sector and the pixel's size the same in all");
  }
  FrameTally::add();
}

GreyFrames::GreyFrames(const std::string& path, const std::string& header, int width, int height, std::size_t count)
  : tally_(path, width, height, count)
  , file_(path)
{
  file_.stream().write(header.data(), std::streamsize(header.size()));
  tally_.requireRoom(bool(file_.stream()));
}

void GreyFrames::add(const std::uint8_t* grey, int width, int height)
{
  tally_.add(width, height);
  file_.stream().write(reinterpret_cast<const char*>(grey), std::streamsize(width) * height);
  tally_.requireRoom(bool(file_.stream()));
}

void GreyFrames::finish(const std::string& padding)
{
  tally_.requireAll();
  file_.stream() << padding;
  tally_.requireRoom(file_.finish());
}

} // namespace sono
