#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace sono {

/// What is made from some numbers and takes a while: those made last are kept, so that the next image, which wants the
/// same, has it at once. Threads may ask together.
template<class Made>
class KeptByNumbers
{
public:
  explicit KeptByNumbers(std::size_t most)
    : most_(most)
  {
  }

  /// `key` holds all that `make()`, which returns a Made, looks at.
  template<class Make>
  std::shared_ptr<const Made> of(std::vector<double> key, const Make& make)
  {
    std::unique_lock<std::mutex> lock(mutex_);
    const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const auto& each) { return each.first == key; });
    if (found != kept_.end())
    {
      return found->second;
    }
    lock.unlock(); // who wants others need not wait
    auto made = std::make_shared<const Made>(make());
    lock.lock();
    kept_.emplace_front(std::move(key), made);
    if (kept_.size() > most_)
    {
      kept_.pop_back();
    }
    return made;
  }

private:
  std::size_t most_;
  std::mutex mutex_;
  std::deque<std::pair<std::vector<double>, std::shared_ptr<const Made>>> kept_;
};

} // namespace sono
