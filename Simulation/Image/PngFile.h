#pragma once

#include <cstdint>
#include <string>

namespace sono {

/// The bytes of a PNG file: 8-bit grey, width x height, rows from the top; square pixels of `pixelMm`, above 0, as its
/// physical size. The same pixels give the same bytes, whichever processor and thread makes them. Quick rather than
/// small: deflated by libdeflate at its first level. Throws std::bad_alloc.
std::string pngBytes(const std::uint8_t* grey, int width, int height, double pixelMm);

} // namespace sono
