#pragma once

#include "DataSets/ImageStream.h"

#include <chrono>
#include <optional>
#include <thread>

namespace sono::testing {

/// Of a stream, waited for; none at the end.
inline std::optional<StreamedImage> next(ImageStream& stream)
{
  std::optional<StreamedImage> taken = stream.takeMade();
  while (!taken && !stream.hasEnded())
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    taken = stream.takeMade();
  }
  return taken;
}

} // namespace sono::testing
