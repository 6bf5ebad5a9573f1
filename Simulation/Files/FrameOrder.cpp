#include "Files/FrameOrder.h"

#include "Core/Error.h"

namespace sono {

FrameOrder::FrameOrder(std::string path, std::size_t values, const std::vector<double>& timesS, std::string what,
                       std::string advice)
  : path_(std::move(path))
  , advice_(std::move(advice))
  , valueCount_(values)
  , frameCount_(timesS.size())
{
  if (frameCount_ == 0 || valueCount_ == 0)
  {
    refuse("there are no " + what + "; simulate some first");
  }
  for (std::size_t n = 1; n < frameCount_; ++n)
  {
    if (!(timesS[n] > timesS[n - 1]))
    {
      refuse("frame " + std::to_string(n + 1) + " is not later than the one before; set times that increase");
    }
  }
}

void FrameOrder::refuse(const std::string& why) const
{
  throw Error("cannot write '" + path_ + "': " + why + ".");
}

std::size_t FrameOrder::next(std::size_t values)
{
  const std::string number = "frame " + std::to_string(added_ + 1);
  if (values != valueCount_)
  {
    refuse(number + " has " + std::to_string(values) + " samples and the first " + std::to_string(valueCount_) + "; " +
           advice_);
  }
  if (added_ == frameCount_)
  {
    refuse(number + " is one more than the " + std::to_string(frameCount_) + " that were announced");
  }
  return added_++;
}

void FrameOrder::finish() const
{
  if (added_ < frameCount_)
  {
    refuse("it has " + std::to_string(added_) + " frames of " + std::to_string(frameCount_));
  }
}

} // namespace sono
