#pragma once

#include "Files/FrameTally.h"

#include <vector>

namespace sono {

/// Frames that come one after the other, all of one size, into a file that announced how many. Throws Error naming the
/// file.
class FrameOrder
{
public:
  /// `values` of each frame; `what` they are of, and what to keep so that they stay as many ("keep ...").
  FrameOrder(const std::string& path, std::size_t values, const std::vector<double>& timesS, const std::string& what,
             std::string advice);

  [[noreturn]] void refuse(const std::string& why) const { tally_.refuse(why); }
  /// The number of the next frame, from 0 on, which has so many values.
  std::size_t next(std::size_t values);
  /// All have come.
  void finish() const { tally_.requireAll(); }

private:
  FrameTally tally_;
  std::string advice_;
  std::size_t valueCount_;
};

} // namespace sono
