#include "Files/FrameTally.h"

#include "Core/Error.h"

namespace sono {

std::string FrameTally::name() const
{
  return noun_ + " " + std::to_string(added_ + 1);
}

void FrameTally::add()
{
  if (added_ == count_)
  {
    refuse(name() + " is one more than the " + std::to_string(count_) + " that were announced");
  }
  ++added_;
}

void FrameTally::requireAll() const
{
  if (added_ < count_)
  {
    refuse("it has " + std::to_string(added_) + " " + noun_ + "s of " + std::to_string(count_));
  }
}

void FrameTally::refuse(const std::string& why) const
{
  throw Error("cannot write '" + path_ + "': " + why + ".");
}

void FrameTally::requireRoom(bool isWritten) const
{
  if (!isWritten)
  {
    refuse("its folder is missing or protected or the disk is full; make room, or choose another folder");
  }
}

} // namespace sono
