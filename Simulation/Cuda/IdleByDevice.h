#pragma once

#include <map>
#include <mutex>

namespace sono {

/// What nobody uses just now of things that a device has and that are never destroyed, since at the end of a process
/// the driver may go first: lanes, imagers. For several threads at a time.
template<class T>
class IdleByDevice
{
public:
  /// One of the device's; null: there is none.
  T* take(int device)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = idle_.find(device);
    if (found == idle_.end())
    {
      return nullptr;
    }
    T* const taken = found->second;
    idle_.erase(found);
    return taken;
  }
  void give(int device, T* thing)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    idle_.emplace(device, thing);
  }

private:
  std::mutex mutex_;
  std::multimap<int, T*> idle_;
};

} // namespace sono
