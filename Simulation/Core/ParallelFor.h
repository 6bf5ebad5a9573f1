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

/// Which cores the loops of a thread run on.
enum class LoopCores
{
  All,
  Own ///< the thread's alone: cores that wait for shares of short loops do so busily
};

/// What holds for the thread that makes it, until it goes. All is what holds otherwise.
class LoopsOn
{
public:
  explicit LoopsOn(LoopCores cores);
  ~LoopsOn();
  LoopsOn(const LoopsOn&) = delete;
  LoopsOn& operator=(const LoopsOn&) = delete;

private:
  LoopCores before_;
};

} // namespace sono
