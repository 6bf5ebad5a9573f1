#include "BackgroundTrace.h"

#include "Core/Error.h"

#include <chrono>
#include <utility>

namespace sono {

namespace {

constexpr std::chrono::milliseconds betweenLooks(20);

} // namespace

BackgroundTrace::BackgroundTrace(std::shared_ptr<const Scene> scene, const std::vector<ScanLine>& lines,
                                 const TraceSettings& settings, const std::vector<TargetSurface>& targets,
                                 const Progress& progress)
  : scene_(std::move(scene))
  , trace_(*scene_, lines, settings, targets, progress)
  , best_(trace_.result())
  , thread_([this] { run(); })
{
}

BackgroundTrace::~BackgroundTrace()
{
  stop_ = true;
  thread_.join();
}

void BackgroundTrace::run()
{
  const Progress progress = [this](double fraction) {
    done_ = fraction;
    return !stop_;
  };
  try
  {
    while (!stop_ && trace_.refine(progress))
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      best_ = trace_.result();
    }
  }
  catch (...)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    failure_ = std::current_exception();
  }
  running_ = false;
}

TracedResult BackgroundTrace::best() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return best_;
}

TracedResult BackgroundTrace::finish(const Progress& progress)
{
  while (running_)
  {
    report(progress, done_);
    std::this_thread::sleep_for(betweenLooks);
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  if (failure_)
  {
    std::rethrow_exception(failure_);
  }
  return best_;
}

} // namespace sono
