#pragma once

#include "Kernel/HostDevice.h"

#include <cstdint>

namespace sono {

/// Paths of a line are traced in this many batches at most; the spread of their means gives the standard error.
constexpr int batchCount = 8;

/// Sums of floats are folded into doubles after this many paths: a long sum loses its last digits, all the more where
/// every path adds the same, and always the same way.
constexpr int pathsPerFold = 512;

struct PathRange
{
  int first;
  int last;

  SONO_HD int count() const { return last - first; }
};
SONO_HD inline PathRange batchRange(int paths, int batches, int batch)
{
  return { int(std::int64_t(paths) * batch / batches), int(std::int64_t(paths) * (batch + 1) / batches) };
}

} // namespace sono
