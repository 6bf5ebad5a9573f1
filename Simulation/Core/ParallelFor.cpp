#include "Core/ParallelFor.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <mutex>

#if defined(SONO_TELL_THREAD_SANITIZER)
#include <sanitizer/tsan_interface.h>
#endif

namespace sono {

namespace {

/// What ThreadSanitizer cannot see in a libtbb that was compiled without it: a loop's tasks come after what came before
/// the loop, and before what comes after it. Between two tasks there is no order.
struct LoopOrder
{
#if defined(SONO_TELL_THREAD_SANITIZER)
  void begin()
  {
    __tsan_release(&begun);
  }
  void beginTask()
  {
    __tsan_acquire(&begun);
  }
  void endTask()
  {
    __tsan_release(&ended);
  }
  void end()
  {
    __tsan_acquire(&ended);
  }

  char begun = 0;
  char ended = 0;
#else
  void begin() {}
  void beginTask() {}
  void endTask() {}
  void end() {}
#endif
};

thread_local LoopCores loopCores = LoopCores::All;

} // namespace

LoopsOn::LoopsOn(LoopCores cores)
  : before_(loopCores)
{
  loopCores = cores;
}

LoopsOn::~LoopsOn()
{
  loopCores = before_;
}

void parallelFor(int count, const Progress& progress, const std::function<void(int, const YieldPoint&)>& body)
{
  std::atomic<int> done{ 0 };
  std::atomic<bool> stop{ false };
  std::mutex reporting;
  const auto reportDone = [&] {
    std::unique_lock<std::mutex> lock(reporting, std::try_to_lock);
    if (progress && lock && !stop && !progress(double(done) / count))
    {
      stop = true;
    }
  };
  const YieldPoint yieldPoint = [&] {
    reportDone();
    if (stop)
    {
      throw Aborted();
    }
  };
  LoopOrder order;
  const auto run = [&](int i) {
    order.beginTask();
    if (!stop)
    {
      body(i, yieldPoint);
      ++done;
      reportDone();
    }
    order.endTask();
  };
  order.begin();
  if (loopCores == LoopCores::All)
  {
    tbb::parallel_for(0, count, run);
  }
  else
  {
    for (int i = 0; i < count; ++i)
    {
      run(i);
    }
  }
  order.end();
  if (stop)
  {
    throw Aborted();
  }
}

void parallelFor(int count, const Progress& progress, const std::function<void(int)>& body)
{
  parallelFor(count, progress, [&](int i, const YieldPoint&) { body(i); });
}

} // namespace sono
