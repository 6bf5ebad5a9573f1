#pragma once

#include <exception>
#include <future>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>

namespace sono {

/// What takes long to make, for several threads: it is made once and lives as long as somebody holds it. While one
/// makes a thing others wait for it; what it throws they throw too.
template<class Key, class Value>
class MadeOnce
{
public:
  using Shared = std::shared_ptr<const Value>;

  /// `make` gives a Shared.
  template<class Make>
  Shared get(const Key& key, const Make& make)
  {
    std::unique_lock<std::mutex> lock(mutex_);
    const auto known = held_.find(key);
    if (Shared there = known == held_.end() ? nullptr : known->second.lock())
    {
      return there;
    }
    const auto found = making_.find(key);
    if (found != making_.end())
    {
      const std::shared_future<Shared> made = found->second;
      lock.unlock();
      return made.get();
    }
    std::promise<Shared> promise;
    const std::shared_future<Shared> made = promise.get_future().share();
    making_[key] = made;
    lock.unlock();
    try
    {
      promise.set_value(make());
    }
    catch (...)
    {
      promise.set_exception(std::current_exception());
    }
    lock.lock();
    making_.erase(key);
    const Shared value = made.get();
    held_[key] = value;                                     // before anybody else looks
    for (auto other = held_.begin(); other != held_.end();) // of thousands, few are held
    {
      other = other->second.expired() ? held_.erase(other) : std::next(other);
    }
    return value;
  }

private:
  std::mutex mutex_;
  std::map<Key, std::weak_ptr<const Value>> held_;
  std::map<Key, std::shared_future<Shared>> making_;
};

} // namespace sono
