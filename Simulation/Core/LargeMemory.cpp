#include "Core/LargeMemory.h"

#include "Core/ParallelFor.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <algorithm>
#include <cstdint>

namespace sono {

namespace {

constexpr std::size_t pageBytes = 4096;
constexpr std::size_t hugePageBytes = std::size_t(1) << 21;
constexpr std::size_t leastBytes = 8 * hugePageBytes; // below, starting the cores costs as much

void askForHugePages([[maybe_unused]] char* memory, [[maybe_unused]] std::size_t bytes)
{
#if defined(MADV_HUGEPAGE)
  const auto at = reinterpret_cast<std::uintptr_t>(memory);
  const std::size_t before = (hugePageBytes - at % hugePageBytes) % hugePageBytes;
  const std::size_t whole = (bytes - before) / hugePageBytes * hugePageBytes;
  madvise(memory + before, whole, MADV_HUGEPAGE); // refused: it goes by small pages
#endif
}

} // namespace

void touchMemory(void* memory, std::size_t bytes)
{
  if (bytes < leastBytes)
  {
    return;
  }
  char* const begin = static_cast<char*>(memory);
  askForHugePages(begin, bytes);
  parallelFor(int((bytes + hugePageBytes - 1) / hugePageBytes), {}, [&](int part) {
    volatile char* const first = begin + std::size_t(part) * hugePageBytes;
    const std::size_t count = std::min(hugePageBytes, bytes - std::size_t(part) * hugePageBytes);
    for (std::size_t at = 0; at < count; at += pageBytes)
    {
      first[at] = 0;
    }
  });
}

} // namespace sono
