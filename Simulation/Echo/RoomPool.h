#pragma once

#include <functional>
#include <mutex>
#include <utility>
#include <vector>

namespace sono {

/// What work needs to write in, kept for the next piece of work of the kind: made anew, its arrays would grow from
/// nothing each time, and memory that is given back comes anew page by page, each with a fault. Not by thread, since a
/// thread may begin another piece while it waits in one.
template<class Room>
class RoomPool
{
public:
  explicit RoomPool(std::function<Room()> make)
    : make_(std::move(make))
  {
  }
  Room take()
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!free_.empty())
      {
        Room room = std::move(free_.back());
        free_.pop_back();
        return room;
      }
    }
    return make_();
  }
  /// Of one that has been left as it has to be found.
  void give(Room room)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    free_.push_back(std::move(room));
  }

private:
  std::function<Room()> make_;
  std::mutex mutex_;
  std::vector<Room> free_;
};

} // namespace sono
