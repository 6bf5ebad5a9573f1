#include "DataSets/Draw.h"

#include "Core/Hash64.h"
#include "Kernel/Rng.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

RandomWords wordsOf(std::uint64_t seed, DrawScope scope, std::int64_t index, std::uint32_t key, std::uint32_t attempt)
{
  const auto number = static_cast<std::uint64_t>(index);
  return philox(seed, std::uint32_t(number), std::uint32_t(number >> 32), key, std::uint32_t(scope) << 16 | attempt);
}

} // namespace

double Draw::at(double uniform) const
{
  if (kind == Kind::OneOf)
  {
    return values[std::min(values.size() - 1, std::size_t(uniform * double(values.size())))];
  }
  const double low = values[0];
  const double high = values[1];
  return whole ? std::min(high, low + std::floor(uniform * (high - low + 1.0))) : low + uniform * (high - low);
}

double Draw::least() const
{
  return *std::min_element(values.begin(), values.end());
}

double Draw::most() const
{
  return *std::max_element(values.begin(), values.end());
}

Draw always(double value)
{
  return { Draw::Kind::OneOf, { value }, false };
}

std::uint32_t drawKey(std::string_view name)
{
  return std::uint32_t(hash64(name.data(), name.size()));
}

double drawUniform(std::uint64_t seed, DrawScope scope, std::int64_t index, std::uint32_t key, std::uint32_t attempt)
{
  const RandomWords words = wordsOf(seed, scope, index, key, attempt);
  return (double(words.v[0] >> 6) * 67108864.0 + double(words.v[1] >> 6)) / 4503599627370496.0; // 26 bits of each
}

std::uint64_t drawSeed(std::uint64_t seed, DrawScope scope, std::int64_t index, std::uint32_t key)
{
  return wordsOf(seed, scope, index, key, 0).v[2] >> 1;
}

} // namespace sono
