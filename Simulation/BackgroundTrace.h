#pragma once

#include "RefinedTrace.h"

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

namespace sono {

/// A RefinedTrace whose first round is made at once and whose further ones follow on a thread of their own, while their
/// picture is looked at. The same rounds, and the same results, as without.
class BackgroundTrace
{
public:
  /// With the first round. Throws as trace().
  BackgroundTrace(std::shared_ptr<const Scene> scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                  const std::vector<TargetSurface>& targets, const Progress& progress);
  /// Stops it, within milliseconds.
  ~BackgroundTrace();
  BackgroundTrace(const BackgroundTrace&) = delete;
  BackgroundTrace& operator=(const BackgroundTrace&) = delete;

  /// Whether more rounds may follow.
  bool isRunning() const { return running_; }
  /// After the last round that has ended.
  TracedResult best() const;
  /// Waits for the last one. Throws Aborted when asked to stop, what stopped it otherwise.
  TracedResult finish(const Progress& progress);

private:
  void run();

  std::shared_ptr<const Scene> scene_;
  RefinedTrace trace_; ///< the thread's
  mutable std::mutex mutex_;
  TracedResult best_;
  std::exception_ptr failure_;
  std::atomic<double> done_{ 0.0 };
  std::atomic<bool> stop_{ false };
  std::atomic<bool> running_{ true };
  std::thread thread_;
};

} // namespace sono
