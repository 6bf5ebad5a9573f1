#pragma once

#include "Core/Policy.h"
#include "LastResults.h"

#include <list>
#include <memory>
#include <mutex>
#include <utility>

namespace sono {

/// Scatterers of the moving tissue of the scenes that were simulated last in this process, while these live: a heart
/// that beats comes back to each of its phases, and one simulator may prepare them for another. What was not used for
/// longest goes when they are too many (keptMovingBytes).
class KeptMoving
{
public:
  /// Those of a scene, or more of them, which `make` makes where they are not kept.
  template<class Make>
  std::shared_ptr<const PointScatterers> get(const std::shared_ptr<const Scene>& scene, const MovingFrom& from,
                                             Make&& make)
  {
    dropDead();
    if (const auto kept = find(scene, from))
    {
      return kept;
    }
    std::shared_ptr<const PointScatterers> made = make();
    const std::lock_guard<std::mutex> lock(mutex_);
    entries_.push_front({ scene, from, made });
    std::size_t bytes = 0;
    for (auto entry = entries_.begin(); entry != entries_.end();)
    {
      bytes += entry->made->table()->bytes();
      const bool isTooMuch = entry != entries_.begin() && bytes > keptMovingBytes;
      entry = isTooMuch ? entries_.erase(entry) : std::next(entry);
    }
    return made;
  }
  /// Those of scenes that have gone.
  void dropDead()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    entries_.remove_if([](const Entry& entry) { return entry.scene.expired(); });
  }

private:
  std::shared_ptr<const PointScatterers> find(const std::shared_ptr<const Scene>& scene, const MovingFrom& from)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (auto entry = entries_.begin(); entry != entries_.end(); ++entry)
    {
      if (entry->scene.lock() == scene && entry->from.holds(from))
      {
        entries_.splice(entries_.begin(), entries_, entry);
        return entry->made;
      }
    }
    return nullptr;
  }

  struct Entry
  {
    std::weak_ptr<const Scene> scene;
    MovingFrom from;
    std::shared_ptr<const PointScatterers> made;
  };
  std::mutex mutex_;
  std::list<Entry> entries_; // the last used first
};

} // namespace sono
