#include "SonoSharedArray.h"

#include <map>
#include <mutex>
#include <utility>

namespace sono {
namespace {

/// VTK's free function gets the memory alone. The same memory may stand in several arrays.
struct Owners
{
  std::mutex mutex;
  std::multimap<const void*, std::shared_ptr<const void>> of;
};

Owners& owners()
{
  static auto* const all = new Owners; // arrays may live until the process ends
  return *all;
}

} // namespace

void keepShared(const void* at, std::shared_ptr<const void> owner)
{
  const std::lock_guard<std::mutex> lock(owners().mutex);
  owners().of.emplace(at, std::move(owner));
}

void freeShared(void* at)
{
  std::shared_ptr<const void> last; // goes after the lock
  const std::lock_guard<std::mutex> lock(owners().mutex);
  const auto found = owners().of.find(at);
  if (found != owners().of.end())
  {
    last = std::move(found->second);
    owners().of.erase(found);
  }
}

} // namespace sono
