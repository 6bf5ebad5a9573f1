#include "Image/PngFile.h"

#include <libdeflate.h>

#include <cmath>
#include <memory>
#include <new>
#include <vector>

namespace sono {

namespace {

void appendNumber(std::uint32_t number, std::string& bytes)
{
  for (int shift = 24; shift >= 0; shift -= 8)
  {
    bytes += char(number >> shift & 0xffu);
  }
}

/// Length, type, content and checksum (PNG specification, section 5).
void appendChunk(const char* type, const std::string& content, std::string& bytes)
{
  appendNumber(std::uint32_t(content.size()), bytes);
  const std::size_t begin = bytes.size();
  bytes += type;
  bytes += content;
  appendNumber(libdeflate_crc32(0, bytes.data() + begin, bytes.size() - begin), bytes);
}

/// A row by filter 1, Sub (PNG specification, section 9): the filter's number, and of each pixel how much it is more
/// than the one before.
void subtractNeighbours(const std::uint8_t* __restrict grey, int width, std::uint8_t* __restrict row)
{
  row[0] = 1;
  row[1] = grey[0];
  for (int x = 1; x < width; ++x)
  {
    row[x + 1] = std::uint8_t(grey[x] - grey[x - 1]);
  }
}

struct FreeCompressor
{
  void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
};

/// The thread's own, since its tables take longer to get than to use; nothing of one stream stays for the next.
libdeflate_compressor* compressor()
{
  constexpr int level = 1;
  thread_local const std::unique_ptr<libdeflate_compressor, FreeCompressor> own(libdeflate_alloc_compressor(level));
  if (!own)
  {
    throw std::bad_alloc();
  }
  return own.get();
}

std::string deflated(const std::vector<std::uint8_t>& raw)
{
  std::string out(libdeflate_zlib_compress_bound(compressor(), raw.size()), '\0');
  out.resize(libdeflate_zlib_compress(compressor(), raw.data(), raw.size(), out.data(), out.size()));
  return out;
}

} // namespace

std::string pngBytes(const std::uint8_t* grey, int width, int height, double pixelMm)
{
  std::string header;
  appendNumber(std::uint32_t(width), header);
  appendNumber(std::uint32_t(height), header);
  header += std::string("\x08\x00\x00\x00\x00", 5); // 8 bits, grey, not interlaced
  std::string size;
  const auto pixelsPerMetre = std::uint32_t(std::lround(1000.0 / pixelMm));
  appendNumber(pixelsPerMetre, size);
  appendNumber(pixelsPerMetre, size);
  size += '\x01'; // metres

  const auto rowBytes = std::size_t(width) + 1;
  std::vector<std::uint8_t> rows(rowBytes * std::size_t(height));
  for (int y = 0; y < height; ++y)
  {
    subtractNeighbours(grey + std::size_t(y) * std::size_t(width), width, rows.data() + std::size_t(y) * rowBytes);
  }
  std::string bytes("\x89PNG\r\n\x1a\n", 8);
  appendChunk("IHDR", header, bytes);
  appendChunk("pHYs", size, bytes);
  appendChunk("IDAT", deflated(rows), bytes);
  appendChunk("IEND", {}, bytes);
  return bytes;
}

} // namespace sono
