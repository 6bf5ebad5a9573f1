#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sono::fuzz {

/// A reader under test.
struct Target
{
  std::string name;     ///< also of its folder in the corpus
  std::string fileName; ///< under which the bytes are handed to it
  void (*read)(const std::string& path);
};

const std::vector<Target>& targets();

/// Where the bytes lie as a file; whoever ends well removes it.
std::string workFolder();

} // namespace sono::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count);
