#include "Core/LargeMemory.h"

#include "Core/ParallelFor.h"

#include <algorithm>

namespace sono {

namespace {

constexpr std::size_t pageBytes = 4096;
constexpr std::size_t partBytes = std::size_t(1) << 21;
constexpr std::size_t leastBytes = 2 * partBytes; // below, starting the cores costs as much

} // namespace

void touchMemory(void* memory, std::size_t bytes)
{
  if (bytes < leastBytes)
  {
    return;
  }
  // Huge pages are not asked for: of a virtual machine's memory they are what its host has to give anew.
  char* const begin = static_cast<char*>(memory);
  parallelFor(int((bytes + partBytes - 1) / partBytes), {}, [&](int part) {
    volatile char* const first = begin + std::size_t(part) * partBytes;
    const std::size_t count = std::min(partBytes, bytes - std::size_t(part) * partBytes);
    for (std::size_t at = 0; at < count; at += pageBytes)
    {
      first[at] = 0;
    }
  });
}

} // namespace sono
