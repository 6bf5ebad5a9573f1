#pragma once

#include "Progress.h"

#include <functional>

namespace sono {

/// Runs body(i) for i in [0, count) on all cores (oneTBB). Which thread runs which i is not defined: a body writes only
/// what belongs to its i. Reports progress and throws Aborted once running bodies have returned; an exception of
/// a body reaches the caller.
void parallelFor(int count, const Progress& progress, const std::function<void(int)>& body);

} // namespace sono
