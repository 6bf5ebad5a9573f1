#include "ParallelFor.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <mutex>

namespace sono {

void parallelFor(int count, const Progress& progress, const std::function<void(int)>& body)
{
  std::atomic<int> done{ 0 };
  std::atomic<bool> stop{ false };
  std::mutex reporting;
  tbb::parallel_for(0, count, [&](int i) {
    if (stop)
    {
      return;
    }
    body(i);
    const int finished = ++done;
    if (!progress)
    {
      return;
    }
    std::unique_lock<std::mutex> lock(reporting, std::try_to_lock);
    if (lock && !stop && !progress(double(finished) / count))
    {
      stop = true;
    }
  });
  if (stop)
  {
    throw Aborted();
  }
}

} // namespace sono
