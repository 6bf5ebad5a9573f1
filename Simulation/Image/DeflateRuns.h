#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace sono {

/// A zlib stream (RFC 1950) of bytes that are noise, or runs of one value: differences of speckle, in which there is
/// nothing to find, and of masks. Each byte is a literal or part of a run, matches are never further away than the byte
/// before, and Huffman's codes are made anew for every 16384 of them. A third of the time of what looks for more
/// matches; the same bytes give the same stream on any machine.
std::string deflateRuns(const std::uint8_t* bytes, std::size_t count);

} // namespace sono
