#pragma once

#include <cstdint>
#include <string>

namespace sono {

/// The bytes of a PNG file: 8-bit grey, width x height, rows from the top; square pixels of `pixelMm`, above 0, as its
/// physical size. Quick rather than small: deflated by ISA-L at its first level, rows as they are, since speckle does
/// not follow its neighbours.
std::string pngBytes(const std::uint8_t* grey, int width, int height, double pixelMm);

} // namespace sono
