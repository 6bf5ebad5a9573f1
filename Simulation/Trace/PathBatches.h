#pragma once

#include "Kernel/HostDevice.h"

#include <cstdint>

namespace sono {

/// Paths of a line are traced in this many batches at most; the spread of their means gives the standard error.
constexpr int batchCount = 8;

/// Paths that every line begins with where there is a target error; each further round doubles those of some lines.
constexpr int firstPaths = 32;

/// Sums of floats are folded into doubles after this many paths of a batch: a long sum loses its last digits, all the
/// more where every path adds the same, and always the same way.
constexpr int pathsPerFold = 512;

/// The next number of paths after which a batch's sums are folded: wherever a round may end as well, so that a line's
/// sums do not depend on the rounds in which it got its paths.
inline int nextFold(int paths)
{
  int next = firstPaths / batchCount;
  while (next <= paths && next < pathsPerFold)
  {
    next *= 2;
  }
  return next <= paths ? (paths / pathsPerFold + 1) * pathsPerFold : next;
}

struct PathRange
{
  int first;
  int last;
};
SONO_HD inline PathRange batchRange(int paths, int batches, int batch)
{
  return { int(std::int64_t(paths) * batch / batches), int(std::int64_t(paths) * (batch + 1) / batches) };
}

} // namespace sono
