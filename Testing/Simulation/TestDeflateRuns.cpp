// Streams of runs, inflated by zlib, which is not what wrote them.
#include "Image/DeflateRuns.h"

#include <zlib.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace sono;

namespace {

using Bytes = std::vector<std::uint8_t>;

/// Empty where it is no whole stream.
Bytes inflated(const std::string& stream, std::size_t count)
{
  Bytes bytes(count + 1);
  uLongf size = bytes.size();
  const int status = uncompress(bytes.data(), &size, reinterpret_cast<const Bytef*>(stream.data()), stream.size());
  EXPECT_EQ(status, Z_OK);
  bytes.resize(status == Z_OK ? size : 0);
  return bytes;
}

void expectSame(const Bytes& bytes)
{
  EXPECT_EQ(inflated(deflateRuns(bytes.data(), bytes.size()), bytes.size()), bytes) << bytes.size() << " bytes";
}

} // namespace

TEST(DeflateRuns, HoldsRunsOfEveryLength)
{
  expectSame({});
  Bytes all;
  for (std::size_t length = 1; length < 600; ++length)
  {
    expectSame(Bytes(length, std::uint8_t(length)));
    all.insert(all.end(), length, std::uint8_t(length % 7));
  }
  expectSame(all);
}

/// Speckle's differences, masks, noise, and counts that halve from byte to byte, whose Huffman code would be longer
/// than a stream may have.
TEST(DeflateRuns, HoldsRandomBytes)
{
  std::mt19937 random(1);
  std::normal_distribution<double> speckle(0.0, 12.0);
  std::geometric_distribution<int> halving(0.5);
  for (int n = 0; n < 300; ++n)
  {
    Bytes bytes(random() % 100000);
    for (std::size_t at = 0; at < bytes.size();)
    {
      const std::size_t run = n % 4 == 1 ? random() % 700 : 1;
      const std::uint8_t kinds[] = { std::uint8_t(std::lround(speckle(random))), std::uint8_t(random() % 6),
                                     std::uint8_t(random()), std::uint8_t(std::min(halving(random), 255)) };
      const std::size_t end = std::min(bytes.size(), at + std::max<std::size_t>(run, 1));
      std::fill(bytes.begin() + std::ptrdiff_t(at), bytes.begin() + std::ptrdiff_t(end), kinds[n % 4]);
      at = end;
    }
    expectSame(bytes);
  }
}

/// As long as is known of Huffman's code: a Fibonacci sequence of counts has a code as long as there are symbols.
TEST(DeflateRuns, CutsCodesThatAreTooLong)
{
  Bytes bytes;
  std::size_t count = 1;
  std::size_t before = 1;
  for (int symbol = 0; symbol < 18; ++symbol)
  {
    bytes.insert(bytes.end(), count, std::uint8_t(symbol));
    before = std::exchange(count, count + before);
  }
  bytes.resize(16000); // one block's
  std::shuffle(bytes.begin(), bytes.end(), std::mt19937(2));
  expectSame(bytes);
}

/// No more than the bytes' entropy, but for the codes' tables: nothing is lost to what Huffman's code cannot say.
TEST(DeflateRuns, IsAsShortAsNoiseAllows)
{
  std::mt19937 random(3);
  std::normal_distribution<double> speckle(0.0, 12.0);
  Bytes bytes(200000);
  std::vector<double> counts(256, 0.0);
  for (std::uint8_t& byte : bytes)
  {
    byte = std::uint8_t(std::lround(speckle(random)));
    counts[byte] += 1.0;
  }
  double bits = 0.0;
  for (const double count : counts)
  {
    bits -= count > 0.0 ? count * std::log2(count / double(bytes.size())) : 0.0;
  }
  EXPECT_LT(double(deflateRuns(bytes.data(), bytes.size()).size()), 1.02 * bits / 8.0);
  EXPECT_LT(deflateRuns(Bytes(200000, 0).data(), 200000).size(), 800u);
}
