#include "Files/FrameOrder.h"

#include <utility>

namespace sono {

FrameOrder::FrameOrder(const std::string& path, std::size_t values, const std::vector<double>& timesS,
                       const std::string& what, std::string advice)
  : tally_(path, "frame", timesS.size())
  , advice_(std::move(advice))
  , valueCount_(values)
{
  if (timesS.empty() || valueCount_ == 0)
  {
    refuse("there are no " + what + "; simulate some first");
  }
  for (std::size_t n = 1; n < timesS.size(); ++n)
  {
    if (!(timesS[n] > timesS[n - 1]))
    {
      refuse("frame " + std::to_string(n + 1) + " is not later than the one before; set times that increase");
    }
  }
}

std::size_t FrameOrder::next(std::size_t values)
{
  if (values != valueCount_)
  {
    refuse(tally_.name() + " has " + std::to_string(values) + " samples and the first " + std::to_string(valueCount_) +
           "; " + advice_);
  }
  const std::size_t number = tally_.added();
  tally_.add();
  return number;
}

} // namespace sono
