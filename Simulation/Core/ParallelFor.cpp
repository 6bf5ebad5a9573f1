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
/// the loop, and before what comes after it, by an exception too. Between two tasks there is no order.
class LoopOrder
{
public:
#if defined(SONO_TELL_THREAD_SANITIZER)
  LoopOrder()
  {
    __tsan_release(&begun_);
  }
  ~LoopOrder()
  {
    __tsan_acquire(&ended_);
  }
  LoopOrder(const LoopOrder&) = delete;
  LoopOrder& operator=(const LoopOrder&) = delete;

  class Task
  {
  public:
    explicit Task(LoopOrder& order)
      : order_(order)
    {
      __tsan_acquire(&order_.begun_);
    }
    ~Task() { __tsan_release(&order_.ended_); }
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;

  private:
    LoopOrder& order_;
  };

private:
  char begun_ = 0;
  char ended_ = 0;
#else
  struct Task
  {
    explicit Task(LoopOrder&) {}
  };
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
    const LoopOrder::Task task(order);
    if (!stop)
    {
      body(i, yieldPoint);
      ++done;
      reportDone();
    }
  };
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
