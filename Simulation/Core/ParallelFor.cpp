#include "Core/ParallelFor.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <mutex>

namespace sono {

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
  tbb::parallel_for(0, count, [&](int i) {
    if (!stop)
    {
      body(i, yieldPoint);
      ++done;
      reportDone();
    }
  });
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
