#pragma once

#include <cstdint>
#include <string>

namespace sono {

/// What the file system says of a file: another text after each change of its content. Empty: there is no such file.
std::string fileStamp(const std::string& path);

/// hash64 of a file's bytes, a part at a time by all cores. Throws Error when it cannot be read.
std::uint64_t fileHash(const std::string& path);

} // namespace sono
