#pragma once

#include <condition_variable>
#include <mutex>

namespace sono {

/// Lets in so many threads at a time; others wait until one leaves.
class Entrance
{
public:
  explicit Entrance(int places)
    : free_(places)
  {
  }

  /// A place, as long as it lives.
  class Stay
  {
  public:
    explicit Stay(Entrance& entrance)
      : entrance_(entrance)
    {
      std::unique_lock<std::mutex> lock(entrance_.mutex_);
      entrance_.left_.wait(lock, [this] { return entrance_.free_ > 0; });
      --entrance_.free_;
    }
    ~Stay()
    {
      const std::lock_guard<std::mutex> lock(entrance_.mutex_);
      ++entrance_.free_;
      entrance_.left_.notify_one();
    }
    Stay(const Stay&) = delete;
    Stay& operator=(const Stay&) = delete;

  private:
    Entrance& entrance_;
  };

private:
  std::mutex mutex_;
  std::condition_variable left_;
  int free_;
};

} // namespace sono
