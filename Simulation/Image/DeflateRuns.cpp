#include "Image/DeflateRuns.h"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

namespace sono {

namespace {

constexpr int literalSymbols = 286; // of literals, the end and lengths (RFC 1951, 3.2.5)
constexpr int endOfBlock = 256;
constexpr std::size_t shortestRun = 4; // beyond the byte that it repeats: below, literals are as short
constexpr std::size_t longestRun = 258;
constexpr std::size_t blockTokens = 16384;
constexpr int longestCode = 15;
constexpr int longestLengthCode = 7;

/// Bits, the first of which is the least significant one, as a little-endian machine has them.
class BitWriter
{
public:
  explicit BitWriter(std::string& to)
    : to_(to)
    , end_(to.size())
  {
  }

  /// For so many bytes at most, before they are put.
  void makeRoom(std::size_t bytes) { to_.resize(end_ + bytes + sizeof held_); }
  /// No more than 56 at a time.
  void put(std::uint64_t bits, unsigned count)
  {
    held_ |= bits << heldCount_;
    heldCount_ += count;
    std::memcpy(to_.data() + end_, &held_, sizeof held_);
    end_ += heldCount_ / 8u;
    held_ >>= heldCount_ & ~7u;
    heldCount_ &= 7u;
  }
  /// Cuts the room that is left, in the middle of a byte after that.
  void finish() { to_.resize(end_ + (heldCount_ > 0u ? 1 : 0)); }

private:
  std::string& to_;
  std::size_t end_; ///< before what is held
  std::uint64_t held_ = 0;
  unsigned heldCount_ = 0;
};

/// A prefix code: of each symbol its bits, the first one last, and their count; 0: it does not occur.
template<int symbols>
struct PrefixCode
{
  std::array<std::uint16_t, symbols> bits{};
  std::array<std::uint8_t, symbols> length{};
};

/// Lengths of Huffman's code, none above `longest`; codes in the order of RFC 1951, 3.2.2.
template<int symbols>
PrefixCode<symbols> huffmanCode(const std::array<std::uint32_t, symbols>& counts, int longest)
{
  struct Node
  {
    std::uint64_t count;
    int parent;
  };
  PrefixCode<symbols> code;
  std::vector<int> order; // of the symbols that occur, rarest first
  for (int symbol = 0; symbol < symbols; ++symbol)
  {
    if (counts[std::size_t(symbol)] > 0)
    {
      order.push_back(symbol);
    }
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return counts[std::size_t(a)] < counts[std::size_t(b)]; });
  const auto used = order.size();
  std::array<int, longestCode + 1> ofLength{};
  if (used == 1)
  {
    ofLength[1] = 1;
  }
  else if (used > 1)
  {
    // Two queues, leaves and inner nodes, both ascending.
    std::vector<Node> nodes;
    nodes.reserve(2 * used - 1);
    for (const int symbol : order)
    {
      nodes.push_back({ counts[std::size_t(symbol)], -1 });
    }
    std::size_t leaf = 0;
    std::size_t inner = used;
    const auto takeRarest = [&] {
      const bool isLeaf = leaf < used && (inner == nodes.size() || nodes[leaf].count <= nodes[inner].count);
      return isLeaf ? leaf++ : inner++;
    };
    while (nodes.size() < 2 * used - 1)
    {
      const std::size_t a = takeRarest();
      const std::size_t b = takeRarest();
      nodes[a].parent = nodes[b].parent = int(nodes.size());
      nodes.push_back({ nodes[a].count + nodes[b].count, -1 });
    }
    std::vector<int> depth(nodes.size(), 0);
    for (std::size_t n = nodes.size() - 1; n-- > 0;)
    {
      depth[n] = depth[std::size_t(nodes[n].parent)] + 1;
      if (n < used)
      {
        ++ofLength[std::size_t(std::min(depth[n], longest))];
      }
    }
    // Codes that were cut have left too little room (Kraft's sum above 1): leaves move one further down.
    std::uint32_t room = 0;
    for (int length = 1; length <= longest; ++length)
    {
      room += std::uint32_t(ofLength[std::size_t(length)]) << (longest - length);
    }
    for (; room > 1u << longest; --room)
    {
      int length = longest - 1;
      while (ofLength[std::size_t(length)] == 0)
      {
        --length;
      }
      --ofLength[std::size_t(length)];
      ofLength[std::size_t(length) + 1] += 2;
      --ofLength[std::size_t(longest)];
    }
  }
  std::size_t next = 0;
  for (int length = longest; length > 0; --length)
  {
    for (int n = 0; n < ofLength[std::size_t(length)]; ++n)
    {
      code.length[std::size_t(order[next++])] = std::uint8_t(length);
    }
  }
  std::uint32_t first = 0;
  std::array<std::uint32_t, longestCode + 1> nextOf{};
  for (std::size_t length = 1; length < nextOf.size(); ++length)
  {
    first = (first + std::uint32_t(ofLength[length - 1])) << 1;
    nextOf[length] = first;
  }
  for (std::size_t symbol = 0; symbol < std::size_t(symbols); ++symbol)
  {
    if (const int length = code.length[symbol])
    {
      const std::uint32_t forward = nextOf[std::size_t(length)]++;
      std::uint32_t backward = 0;
      for (int bit = 0; bit < length; ++bit)
      {
        backward |= (forward >> bit & 1u) << (length - 1 - bit);
      }
      code.bits[symbol] = std::uint16_t(backward);
    }
  }
  return code;
}

/// How a run's length is written: a symbol, and bits behind it (RFC 1951, 3.2.5).
struct RunLength
{
  std::uint16_t symbol;
  std::uint8_t extraCount;
  std::uint8_t extra;
};

const std::array<RunLength, longestRun + 1>& runLengths()
{
  static const std::array<RunLength, longestRun + 1> all = [] {
    std::array<RunLength, longestRun + 1> made{};
    std::size_t length = 3;
    for (int symbol = 257; symbol < 285; ++symbol)
    {
      const int extraCount = std::max(0, (symbol - 261) / 4);
      for (int extra = 0; extra < 1 << extraCount && length < longestRun; ++extra)
      {
        made[length++] = { std::uint16_t(symbol), std::uint8_t(extraCount), std::uint8_t(extra) };
      }
    }
    made[longestRun] = { 285, 0, 0 };
    return made;
  }();
  return all;
}

/// What a block holds: below 256 a literal, else 256 and the length of a run.
struct Tokens
{
  std::array<std::uint16_t, blockTokens> token;
  std::size_t count = 0;

  void add(std::size_t value) { token[count++] = std::uint16_t(value); }
  const std::uint16_t* begin() const { return token.data(); }
  const std::uint16_t* end() const { return token.data() + count; }
};

/// The tokens of the bytes from `at` on, at most blockTokens, and where they end.
std::size_t tokenise(const std::uint8_t* bytes, std::size_t at, std::size_t count, Tokens& tokens)
{
  tokens.count = 0;
  while (at < count && tokens.count + 1 < blockTokens)
  {
    const std::uint8_t value = bytes[at++];
    tokens.add(value);
    const std::uint64_t eight = value * 0x0101010101010101ull;
    std::uint32_t four = 0;
    if (at + shortestRun > count || (std::memcpy(&four, bytes + at, 4), four != std::uint32_t(eight)))
    {
      continue;
    }
    std::size_t end = at + shortestRun;
    const std::size_t farthest = std::min(count, at + longestRun);
    std::uint64_t next = 0;
    while (end + 8 <= farthest && (std::memcpy(&next, bytes + end, 8), next == eight))
    {
      end += 8;
    }
    while (end < farthest && bytes[end] == value)
    {
      ++end;
    }
    tokens.add(256 + (end - at));
    at = end;
  }
  return at;
}

/// Lengths of codes, themselves in a code of lengths and repeats (RFC 1951, 3.2.7).
void putCodes(const std::uint8_t* lengths, int literals, int distances, BitWriter& to)
{
  struct Part
  {
    int symbol, extra, extraCount;
  };
  std::vector<Part> parts;
  const int count = literals + distances;
  for (int n = 0; n < count;)
  {
    int same = 1;
    while (n + same < count && lengths[n + same] == lengths[n])
    {
      ++same;
    }
    if (lengths[n] == 0 && same >= 3)
    {
      same = std::min(same, 138);
      parts.push_back(same < 11 ? Part{ 17, same - 3, 3 } : Part{ 18, same - 11, 7 });
      n += same;
      continue;
    }
    parts.push_back({ lengths[n], 0, 0 });
    ++n;
    if (--same >= 3)
    {
      same = std::min(same, 6);
      parts.push_back({ 16, same - 3, 2 });
      n += same;
    }
  }
  std::array<std::uint32_t, 19> counts{};
  for (const Part& part : parts)
  {
    ++counts[std::size_t(part.symbol)];
  }
  const PrefixCode<19> code = huffmanCode<19>(counts, longestLengthCode);
  constexpr std::array<int, 19> order{ 16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15 };
  int last = 19;
  while (last > 4 && code.length[std::size_t(order[std::size_t(last - 1)])] == 0)
  {
    --last;
  }
  to.put(std::uint64_t(literals - 257), 5);
  to.put(std::uint64_t(distances - 1), 5);
  to.put(std::uint64_t(last - 4), 4);
  for (int n = 0; n < last; ++n)
  {
    to.put(code.length[std::size_t(order[std::size_t(n)])], 3);
  }
  for (const Part& part : parts)
  {
    to.put(code.bits[std::size_t(part.symbol)], code.length[std::size_t(part.symbol)]);
    to.put(std::uint64_t(part.extra), unsigned(part.extraCount));
  }
}

void putBlock(const Tokens& tokens, bool isLast, BitWriter& to)
{
  const std::array<RunLength, longestRun + 1>& runs = runLengths();
  std::array<std::uint32_t, 512 + 3> byToken{};
  for (const std::uint16_t token : tokens)
  {
    ++byToken[token];
  }
  std::array<std::uint32_t, literalSymbols> counts{};
  std::copy_n(byToken.begin(), 256, counts.begin());
  counts[endOfBlock] = 1;
  for (std::size_t length = shortestRun; length <= longestRun; ++length)
  {
    counts[runs[length].symbol] += byToken[256 + length];
  }
  const PrefixCode<literalSymbols> code = huffmanCode<literalSymbols>(counts, longestCode);
  int literals = literalSymbols;
  while (literals > 257 && code.length[std::size_t(literals - 1)] == 0)
  {
    --literals;
  }
  std::array<std::uint8_t, literalSymbols + 1> lengths{};
  std::copy_n(code.length.begin(), literals, lengths.begin());
  lengths[std::size_t(literals)] = 1; // of the one distance, 1: a code of one bit, 0
  to.put(isLast ? 1 : 0, 1);
  to.put(2, 2);
  putCodes(lengths.data(), literals, 1, to);
  // What a token's bits are, all of them.
  std::array<std::uint32_t, 512 + 3> bits{};
  std::array<std::uint8_t, 512 + 3> lengthOf{};
  std::copy_n(code.bits.begin(), 256, bits.begin());
  std::copy_n(code.length.begin(), 256, lengthOf.begin());
  for (std::size_t length = shortestRun; length <= longestRun; ++length)
  {
    const RunLength& run = runs[length];
    const int own = code.length[run.symbol];
    bits[256 + length] = code.bits[run.symbol] | std::uint32_t(run.extra) << own;
    lengthOf[256 + length] = std::uint8_t(own + run.extraCount + 1);
  }
  const std::uint16_t* token = tokens.begin();
  for (; token + 1 < tokens.end(); token += 2) // two at a time, since each waits for where the one before ends
  {
    const unsigned first = lengthOf[token[0]];
    to.put(bits[token[0]] | std::uint64_t(bits[token[1]]) << first, first + lengthOf[token[1]]);
  }
  if (token < tokens.end())
  {
    to.put(bits[*token], lengthOf[*token]);
  }
  to.put(code.bits[endOfBlock], code.length[endOfBlock]);
}

} // namespace

std::string deflateRuns(const std::uint8_t* bytes, std::size_t count)
{
  constexpr std::size_t mostOfCodes = 512; // 286 symbols of 7 bits and 7 more
  std::string stream("\x78\x01", 2);
  stream.reserve(count / 2);
  BitWriter to(stream);
  Tokens tokens;
  std::size_t at = 0;
  do
  {
    at = tokenise(bytes, at, count, tokens);
    to.makeRoom(mostOfCodes + tokens.count * sizeof(std::uint32_t)); // a run has no more than 21 bits
    putBlock(tokens, at == count, to);
  }
  while (at < count);
  to.finish();
  const std::uint32_t checksum = libdeflate_adler32(1, bytes, count);
  for (int shift = 24; shift >= 0; shift -= 8)
  {
    stream += char(checksum >> shift & 0xffu);
  }
  return stream;
}

} // namespace sono
