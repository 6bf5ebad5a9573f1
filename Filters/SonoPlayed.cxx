#include "SonoPlayed.h"

#include "vtkImageData.h"
#include "vtkSmartPointer.h"

#include <vtksys/SystemInformation.hxx>

#include <algorithm>
#include <iterator>
#include <list>
#include <malloc.h>
#include <mutex>
#include <utility>

namespace sono {
namespace {

constexpr std::size_t mostBytes = std::size_t(4) << 30;
constexpr double shareOfMemory = 0.25;
constexpr double leastFree = 0.1; // of the machine's memory

struct Played
{
  const void* owner;
  std::string key;
  std::shared_ptr<const void> thing;
  std::size_t bytes;
};

class Machine
{
public:
  Machine() { system_.RunMemoryCheck(); }
  double totalBytes() { return 1024.0 * double(system_.GetHostMemoryTotal()); }
  double freeShare() { return 1.0 - double(system_.GetHostMemoryUsed()) / double(system_.GetHostMemoryTotal()); }

private:
  vtksys::SystemInformation system_;
};

struct Store
{
  std::list<Played> things; // last used first
  std::size_t bytes = 0;
  std::size_t limit = std::min(mostBytes, std::size_t(shareOfMemory* Machine().totalBytes()));

  void remove(std::list<Played>::iterator thing)
  {
    bytes -= thing->bytes;
    things.erase(thing);
  }
  void removeLast() { remove(std::prev(things.end())); }
  void trim()
  {
    const std::size_t before = bytes;
    while (!things.empty() && bytes > limit)
    {
      removeLast();
    }
    Machine machine;
    while (things.size() > 1 && machine.freeShare() < leastFree)
    {
      removeLast();
    }
    giveBack(before);
  }
  /// The C library keeps what was freed for its own next use, unless it is asked.
  void giveBack(std::size_t before)
  {
#ifdef __GLIBC__
    if (bytes < before)
    {
      malloc_trim(0);
    }
#endif
  }
  std::list<Played>::iterator find(const std::string& key)
  {
    return std::find_if(things.begin(), things.end(), [&](const Played& played) { return played.key == key; });
  }
  std::list<Played>::iterator find(const void* owner, const std::string& key)
  {
    return std::find_if(things.begin(), things.end(),
                        [&](const Played& played) { return played.owner == owner && played.key == key; });
  }
  std::shared_ptr<const void> use(std::list<Played>::iterator found)
  {
    if (found == things.end())
    {
      return nullptr;
    }
    things.splice(things.begin(), things, found);
    return found->thing;
  }
  void keep(Played played)
  {
    if (played.bytes <= limit)
    {
      bytes += played.bytes;
      things.push_front(std::move(played));
      trim();
    }
  }
};

/// Never destroyed: filters that outlive the program's globals still drop what they kept.
Store& store()
{
  static Store& all = *new Store;
  return all;
}

/// Of several threads.
std::unique_lock<std::mutex> lockStore()
{
  static std::mutex& mutex = *new std::mutex;
  return std::unique_lock<std::mutex>(mutex);
}

std::string phaseKey(int phase)
{
  return "phase " + std::to_string(phase);
}

} // namespace

std::size_t playedLimitBytes()
{
  const auto lock = lockStore();
  return store().limit;
}

void setPlayedLimitBytes(std::size_t bytes)
{
  const auto lock = lockStore();
  store().limit = bytes;
  store().trim();
}

std::size_t playedBytes()
{
  const auto lock = lockStore();
  return store().bytes;
}

std::shared_ptr<const void> findPlayed(const std::string& key)
{
  const auto lock = lockStore();
  return store().use(store().find(key));
}

void keepPlayed(const void* owner, const std::string& key, std::shared_ptr<const void> thing, std::size_t bytes)
{
  const auto lock = lockStore();
  const auto before = store().find(key);
  if (before != store().things.end())
  {
    store().remove(before);
  }
  store().keep({ owner, key, std::move(thing), bytes });
}

void dropPlayed(const void* owner)
{
  const auto lock = lockStore();
  std::list<Played>& things = store().things;
  const std::size_t before = store().bytes;
  for (auto thing = things.begin(); thing != things.end();)
  {
    const auto next = std::next(thing);
    if (thing->owner == owner)
    {
      store().remove(thing);
    }
    thing = next;
  }
  store().giveBack(before);
}

void givePlayed(const void* owner, const void* next)
{
  const auto lock = lockStore();
  std::list<Played>& things = store().things;
  for (auto thing = things.begin(); thing != things.end();)
  {
    const auto given = thing++;
    if (given->owner == owner)
    {
      const bool isThere = store().find(next, given->key) != things.end();
      given->owner = next;
      if (isThere)
      {
        store().remove(given);
      }
    }
  }
}

bool takePlayedPhase(const void* source, int phase, vtkImageData* image)
{
  const auto lock = lockStore();
  const auto kept =
    std::static_pointer_cast<const vtkSmartPointer<vtkImageData>>(store().use(store().find(source, phaseKey(phase))));
  if (kept)
  {
    image->ShallowCopy(*kept);
  }
  return kept != nullptr;
}

void keepPlayedPhase(const void* source, int phase, vtkImageData* image)
{
  const auto lock = lockStore();
  if (store().find(source, phaseKey(phase)) != store().things.end())
  {
    return; // given by another
  }
  // A copy: the pipeline empties its own.
  const auto copy = std::make_shared<vtkSmartPointer<vtkImageData>>(vtkSmartPointer<vtkImageData>::New());
  (*copy)->ShallowCopy(image);
  store().keep({ source, phaseKey(phase), copy, 1024 * std::size_t((*copy)->GetActualMemorySize()) });
}

} // namespace sono
