// The bytes of PNG files.
#include "Image/PngFile.h"

#include <zlib.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

using namespace sono;

namespace {

/// Some noise, runs of one value, and a mask's steps.
std::vector<std::uint8_t> pixels(int width, int height, unsigned seed)
{
  std::vector<std::uint8_t> grey(std::size_t(width) * std::size_t(height));
  for (std::size_t i = 0; i < grey.size(); ++i)
  {
    const auto noise = std::uint8_t((i + seed) * (i + seed) * 2654435761u >> 13);
    const std::array<std::uint8_t, 4> kinds{ noise, 0, std::uint8_t(100 + noise % 8), std::uint8_t(i / 97 % 6) };
    grey[i] = kinds[i / std::size_t(width) / 16 % kinds.size()];
  }
  return grey;
}

/// What a PNG file says by its specification, with zlib, which is not what wrote it.
struct ReadPng
{
  explicit ReadPng(const std::string& bytes)
  {
    EXPECT_EQ(bytes.substr(0, 8), std::string("\x89PNG\r\n\x1a\n", 8));
    const auto number = [&](std::size_t at) {
      const auto byte = [&](std::size_t n) { return std::uint32_t(std::uint8_t(bytes[at + n])); };
      return byte(0) << 24 | byte(1) << 16 | byte(2) << 8 | byte(3);
    };
    for (std::size_t at = 8; at < bytes.size();)
    {
      const std::uint32_t length = number(at);
      const auto* content = reinterpret_cast<const Bytef*>(bytes.data() + at + 4);
      EXPECT_EQ(number(at + 8 + length), crc32(0, content, length + 4));
      chunks += bytes.substr(at + 4, 4) + " ";
      if (bytes.compare(at + 4, 4, "IHDR") == 0)
      {
        width = number(at + 8);
        height = number(at + 12);
      }
      if (bytes.compare(at + 4, 4, "IDAT") == 0)
      {
        std::vector<std::uint8_t> rows((width + 1) * height);
        uLongf size = rows.size();
        EXPECT_EQ(uncompress(rows.data(), &size, content + 4, length), Z_OK);
        EXPECT_EQ(size, rows.size());
        addUp(rows);
      }
      at += 12 + length;
    }
  }

  void addUp(const std::vector<std::uint8_t>& rows)
  {
    for (std::size_t y = 0; y < height; ++y)
    {
      EXPECT_EQ(rows[y * (width + 1)], 1); // differences from the pixel before
      std::uint8_t value = 0;
      for (std::size_t x = 1; x <= width; ++x)
      {
        value = std::uint8_t(value + rows[y * (width + 1) + x]);
        grey.push_back(value);
      }
    }
  }

  std::size_t width = 0;
  std::size_t height = 0;
  std::string chunks;
  std::vector<std::uint8_t> grey;
};

} // namespace

TEST(PngFile, HoldsThePixels)
{
  for (const int width : { 1, 2, 301 })
  {
    const std::vector<std::uint8_t> grey = pixels(width, 77, 0);
    const ReadPng read(pngBytes(grey.data(), width, 77, 0.4));
    EXPECT_EQ(read.width, std::size_t(width));
    EXPECT_EQ(read.height, 77u);
    EXPECT_EQ(read.chunks, "IHDR pHYs IDAT IEND ");
    EXPECT_EQ(read.grey, grey);
  }
}

/// Wherever the pixels lie in memory, and whatever was written before, on several threads at a time.
TEST(PngFile, SamePixelsGiveTheSameBytes)
{
  const int width = 373;
  const int height = 241;
  const std::vector<std::uint8_t> grey = pixels(width, height, 0);
  const std::string expected = pngBytes(grey.data(), width, height, 0.4);
  std::vector<std::thread> threads;
  std::array<int, 4> others{};
  for (std::size_t thread = 0; thread < others.size(); ++thread)
  {
    threads.emplace_back([&, thread] {
      for (unsigned n = 0; n < 40; ++n)
      {
        const int before = 30 + 41 * int(n);
        pngBytes(pixels(before, 50, n).data(), before, 50, 0.4);
        const std::size_t shift = n + 40 * thread;
        std::vector<std::uint8_t> room(shift + grey.size());
        std::copy(grey.begin(), grey.end(), room.begin() + std::ptrdiff_t(shift));
        others[thread] += pngBytes(room.data() + shift, width, height, 0.4) == expected ? 0 : 1;
      }
    });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(others, (std::array<int, 4>{}));
}
