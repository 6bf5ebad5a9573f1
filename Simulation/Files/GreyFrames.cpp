#include "Files/GreyFrames.h"

#include "Core/Error.h"

#include <ostream>

namespace sono {

std::string sizeText(int width, int height)
{
  return std::to_string(width) + " x " + std::to_string(height) + " pixels";
}

GreyFrames::GreyFrames(const std::string& path, const std::string& header, int width, int height, std::size_t count)
  : path_(path)
  , width_(width)
  , height_(height)
  , count_(count)
  , file_(path)
{
  file_.stream().write(header.data(), std::streamsize(header.size()));
  requireRoom(bool(file_.stream()));
}

void GreyFrames::refuse(const std::string& why) const
{
  throw Error("cannot write '" + path_ + "': " + why + ".");
}

void GreyFrames::requireRoom(bool ok) const
{
  if (!ok)
  {
    refuse("its folder is missing or protected or the disk is full; make room, or choose another folder");
  }
}

void GreyFrames::add(const std::uint8_t* grey, int width, int height)
{
  const std::string number = "picture " + std::to_string(added_ + 1);
  if (width != width_ || height != height_)
  {
    refuse(number + " has " + sizeText(width, height) + " and the first " + sizeText(width_, height_) +
           "; keep the probe's depth, its sector and the pixel's size the same in all");
  }
  if (added_ == count_)
  {
    refuse(number + " is one more than the " + std::to_string(count_) + " that were announced");
  }
  ++added_;
  file_.stream().write(reinterpret_cast<const char*>(grey), std::streamsize(width) * height);
  requireRoom(bool(file_.stream()));
}

void GreyFrames::finish(const std::string& padding)
{
  if (added_ < count_)
  {
    refuse("it has " + std::to_string(added_) + " pictures of " + std::to_string(count_));
  }
  file_.stream() << padding;
  requireRoom(file_.finish());
}

} // namespace sono
