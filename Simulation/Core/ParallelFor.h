#pragma once

#include "Core/Progress.h"

#include <functional>

namespace sono {

/// Runs body(i) for i in [0, count) on all cores (oneTBB). Which thread runs which i is not defined: a body writes only
/// what belongs to its i. Reports progress and throws Aborted once running bodies have returned; an exception of
/// a body reaches the caller.
void parallelFor(int count, const Progress& progress, const std::function<void(int)>& body);

/// For a body that takes long: it calls this now and then, every few milliseconds, so that a stop need not wait for its
/// end. Throws Aborted, which the body lets pass.
using YieldPoint = std::function<void()>;

/// The same for bodies that take long.
void parallelFor(int count, const Progress& progress, const std::function<void(int, const YieldPoint&)>& body);

} // namespace sono
