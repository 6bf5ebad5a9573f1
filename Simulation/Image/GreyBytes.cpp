#include "Image/GreyBytes.h"

#include "Core/ParallelFor.h"
#include "Kernel/GreyByte.h"

#include <algorithm>

namespace sono {

std::vector<std::uint8_t> greyBytes(const std::vector<float>& grey, const std::vector<std::uint8_t>& mask)
{
  std::vector<std::uint8_t> bytes(grey.size());
  constexpr std::size_t together = 65536;
  parallelFor(int((grey.size() + together - 1) / together), {}, [&](int part) {
    const std::size_t first = std::size_t(part) * together;
    const std::size_t end = std::min(first + together, grey.size());
    for (std::size_t i = first; i < end; ++i)
    {
      bytes[i] = mask[i] ? greyByte(grey[i]) : std::uint8_t(0);
    }
  });
  return bytes;
}

} // namespace sono
