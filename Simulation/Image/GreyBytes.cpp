#include "Image/GreyBytes.h"

#include "Kernel/GreyByte.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace sono {

std::vector<std::uint8_t> greyBytes(const std::vector<float>& grey, const std::vector<std::uint8_t>& mask)
{
  std::vector<std::uint8_t> bytes(grey.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, grey.size(), 65536),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i)
                      {
                        bytes[i] = mask[i] ? greyByte(grey[i]) : std::uint8_t(0);
                      }
                    });
  return bytes;
}

} // namespace sono
