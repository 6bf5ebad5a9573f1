#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace sono::fuzz {

using Bytes = std::vector<std::uint8_t>;

/// `input` with one to eight changes: bits, bytes, numbers at the edges of their types (binary and as text), parts left
/// out, doubled, moved in from `other`, or cut off.
Bytes mutated(Bytes input, const Bytes& other, std::mt19937_64& random);

} // namespace sono::fuzz
