#include "Mutate.h"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace sono::fuzz {

namespace {

constexpr std::size_t longest = 1 << 16; // small inputs find the same faults sooner

std::size_t below(std::size_t end, std::mt19937_64& random)
{
  return end == 0 ? 0 : std::size_t(random() % end);
}

void overwrite(Bytes& bytes, std::size_t at, const void* value, std::size_t count)
{
  count = std::min(count, bytes.size() - at);
  std::memcpy(bytes.data() + at, value, count);
}

/// A number of 1 to 8 bytes where formats have their sizes and offsets, in either byte order.
void putNumber(Bytes& bytes, std::mt19937_64& random)
{
  static const std::uint64_t edges[] = { 0,          1,          2,           3,     7,         8,     16,
                                         255,        256,        32767,       32768, 65535,     65536, 0x7FFFFFFF,
                                         0x80000000, 0xFFFFFFFF, 0x100000000, ~0ull, 1ull << 63 };
  std::uint64_t value = edges[below(std::size(edges), random)] + (random() % 4 == 0 ? random() % 3 - 1 : 0);
  const std::size_t width = std::size_t(1) << below(4, random);
  if (random() % 4 == 0)
  {
    value = __builtin_bswap64(value) >> (64 - 8 * width);
  }
  overwrite(bytes, below(bytes.size(), random), &value, width);
}

void putFloat(Bytes& bytes, std::mt19937_64& random)
{
  static const float edges[] = { 0.0f, -1.0f, 1e-30f, 1e30f, 3.4e38f, __builtin_nanf(""), __builtin_inff(), 352.0f };
  overwrite(bytes, below(bytes.size(), random) & ~std::size_t(3), &edges[below(std::size(edges), random)], 4);
}

/// Another number for one that is written in digits.
void putText(Bytes& bytes, std::mt19937_64& random)
{
  static const std::string edges[] = { "0",    "-1",  "1",   "2",          "65535",      "65536",
                                       "1e99", "nan", "inf", "4294967296", "2147483648", "99999999999999999999",
                                       "",     ",",   "\"",  "1e-300",     "none",       "3 3 3" };
  std::size_t at = below(bytes.size(), random);
  while (at < bytes.size() && std::isdigit(bytes[at]) == 0)
  {
    ++at;
  }
  std::size_t end = at;
  while (end < bytes.size() && std::isdigit(bytes[end]) != 0)
  {
    ++end;
  }
  const std::string& text = edges[below(std::size(edges), random)];
  bytes.erase(bytes.begin() + std::ptrdiff_t(at), bytes.begin() + std::ptrdiff_t(end));
  bytes.insert(bytes.begin() + std::ptrdiff_t(at), text.begin(), text.end());
}

void insertPart(Bytes& bytes, const Bytes& from, std::mt19937_64& random)
{
  const std::size_t begin = below(from.size(), random);
  const std::size_t count = std::min(from.size() - begin, std::size_t(1) << below(9, random));
  const Bytes part(from.begin() + std::ptrdiff_t(begin), from.begin() + std::ptrdiff_t(begin + count));
  const std::size_t at = below(bytes.size() + 1, random);
  if (random() % 2 == 0)
  {
    bytes.insert(bytes.begin() + std::ptrdiff_t(at), part.begin(), part.end());
  }
  else if (at < bytes.size())
  {
    overwrite(bytes, at, part.data(), part.size());
  }
}

void change(Bytes& bytes, const Bytes& other, std::mt19937_64& random)
{
  const std::size_t at = below(bytes.size(), random);
  switch (random() % 9)
  {
    case 0:
      bytes[at] = std::uint8_t(bytes[at] ^ (1u << random() % 8));
      break;
    case 1:
      bytes[at] = std::uint8_t(random());
      break;
    case 2:
      putNumber(bytes, random);
      break;
    case 3:
      putFloat(bytes, random);
      break;
    case 4:
      putText(bytes, random);
      break;
    case 5:
      bytes.erase(bytes.begin() + std::ptrdiff_t(at),
                  bytes.begin() + std::ptrdiff_t(std::min(bytes.size(), at + (std::size_t(1) << below(8, random)))));
      break;
    case 6:
      insertPart(bytes, Bytes(bytes), random);
      break;
    case 7:
      insertPart(bytes, other, random);
      break;
    default:
      bytes.resize(random() % 4 == 0 ? at : bytes.size());
      break;
  }
}

} // namespace

Bytes mutated(Bytes input, const Bytes& other, std::mt19937_64& random)
{
  for (std::uint64_t changes = 1 + random() % 8; changes > 0 && !input.empty(); --changes)
  {
    change(input, other, random);
  }
  input.resize(std::min(input.size(), longest));
  return input;
}

} // namespace sono::fuzz
