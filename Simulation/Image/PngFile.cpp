#include "Image/PngFile.h"

#include <isa-l/crc.h>
#include <isa-l/igzip_lib.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>
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
  const auto* from = reinterpret_cast<const unsigned char*>(bytes.data() + begin);
  appendNumber(crc32_gzip_refl(0, from, bytes.size() - begin), bytes);
}

std::string deflated(std::vector<std::uint8_t> raw)
{
  std::vector<std::uint8_t> room(ISAL_DEF_LVL1_DEFAULT);
  std::string out(raw.size() + raw.size() / 16 + 4096, '\0');
  const auto stream = std::make_unique<isal_zstream>();
  isal_deflate_init(stream.get());
  stream->level = 1;
  stream->level_buf = room.data();
  stream->level_buf_size = std::uint32_t(room.size());
  stream->gzip_flag = IGZIP_ZLIB;
  stream->end_of_stream = 1;
  stream->flush = NO_FLUSH;
  stream->next_in = raw.data();
  stream->avail_in = std::uint32_t(raw.size());
  stream->next_out = reinterpret_cast<std::uint8_t*>(out.data());
  stream->avail_out = std::uint32_t(out.size());
  if (isal_deflate(stream.get()) != COMP_OK || stream->internal_state.state != ZSTATE_END)
  {
    throw std::logic_error("deflate was given too little room");
  }
  out.resize(stream->total_out);
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
  std::vector<std::uint8_t> rows(rowBytes * std::size_t(height)); // each begins with its filter, 0: none
  for (int y = 0; y < height; ++y)
  {
    std::memcpy(rows.data() + std::size_t(y) * rowBytes + 1, grey + std::size_t(y) * std::size_t(width),
                std::size_t(width));
  }
  std::string bytes("\x89PNG\r\n\x1a\n", 8);
  appendChunk("IHDR", header, bytes);
  appendChunk("pHYs", size, bytes);
  appendChunk("IDAT", deflated(std::move(rows)), bytes);
  appendChunk("IEND", {}, bytes);
  return bytes;
}

} // namespace sono
