#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

namespace sono {

/// A 64-bit fingerprint of a block of memory, the same on all little-endian machines. It tells damaged or different
/// data from equal ones; it is no protection against somebody who wants two blocks to agree.
/// Four multiply-rotate lanes of 8 bytes (after XXH64, Y. Collet), so that it runs at the memory's speed.
inline std::uint64_t hash64(const void* data, std::size_t bytes, std::uint64_t seed = 0)
{
  constexpr std::uint64_t p1 = 0x9E3779B185EBCA87u;
  constexpr std::uint64_t p2 = 0xC2B2AE3D27D4EB4Fu;
  const auto rotate = [](std::uint64_t x, int r) { return (x << r) | (x >> (64 - r)); };
  const auto round = [&](std::uint64_t lane, std::uint64_t word) { return rotate(lane + word * p2, 31) * p1; };
  const auto* at = static_cast<const unsigned char*>(data);
  std::uint64_t lane[4] = { seed + p1 + p2, seed + p2, seed, seed - p1 };
  std::size_t left = bytes;
  for (; left >= 32; left -= 32, at += 32)
  {
    std::uint64_t word[4];
    std::memcpy(word, at, 32);
    for (int n = 0; n < 4; ++n)
    {
      lane[n] = round(lane[n], word[n]);
    }
  }
  std::uint64_t hash = rotate(lane[0], 1) + rotate(lane[1], 7) + rotate(lane[2], 12) + rotate(lane[3], 18);
  for (; left > 0; left -= left < 8 ? left : 8)
  {
    std::uint64_t word = 0;
    const std::size_t count = left < 8 ? left : 8;
    std::memcpy(&word, at, count);
    at += count;
    hash = rotate(hash ^ round(0, word), 27) * p1 + p2;
  }
  hash ^= std::uint64_t(bytes);
  hash = (hash ^ (hash >> 33)) * p2;
  hash = (hash ^ (hash >> 29)) * p1;
  return hash ^ (hash >> 32);
}

constexpr std::size_t hashDigitCount = 16;

/// In hexadecimal, small letters, with leading zeros.
inline std::string hashDigits(std::uint64_t hash)
{
  char digits[hashDigitCount + 1];
  std::snprintf(digits, sizeof(digits), "%016llx", static_cast<unsigned long long>(hash));
  return digits;
}

} // namespace sono
