#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace sono {

/// The bytes of a file in their order, inflated on the way where they are compressed, so that no second copy of a
/// volume is held. Every function throws Error naming the file when its bytes end too early or do not inflate.
class ByteStream
{
public:
  enum class Packing
  {
    None,
    Deflate ///< zlib or gzip, as its first bytes say; gzip may have several members, one after the other
  };

  /// What deflate makes of one byte at most: a match of 258 bytes takes two bits.
  static constexpr std::uint64_t largestInflation = 1032;

  /// From byte `start` of the file at `path` on; `name` is the file that messages speak of.
  ByteStream(const std::string& path, std::uint64_t start, Packing packing, std::string name);
  /// From where an open file stands on; closes it at the end.
  ByteStream(std::FILE* file, Packing packing, std::string name);
  /// Of bytes in memory.
  ByteStream(std::vector<char> bytes, std::string name);
  ~ByteStream();
  ByteStream(ByteStream&&) noexcept;
  ByteStream& operator=(ByteStream&&) noexcept;

  /// Throws when there cannot be `bytes` more: asked before memory is taken for what a header promises.
  void need(std::uint64_t bytes) const;
  void read(void* to, std::size_t bytes);
  void skip(std::uint64_t bytes);
  /// After the last byte that is wanted: compares the checksum where compression has one.
  void finish();
  /// Share of the file that was read so far, 0 to 1.
  double fraction() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether a file begins as gzip does.
bool isGzip(const std::string& path);

} // namespace sono
