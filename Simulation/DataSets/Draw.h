#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace sono {

/// How a number of a data set is drawn.
struct Draw
{
  enum class Kind
  {
    Uniform, ///< between values[0] and values[1], both included where it is whole
    OneOf    ///< of the values, each as likely
  };
  Kind kind = Kind::OneOf;
  std::vector<double> values{ 0.0 };
  bool whole = false;

  /// `uniform` in [0, 1).
  double at(double uniform) const;
  double least() const;
  double most() const;
};

/// One number, always.
Draw always(double value);

/// What a number is drawn for.
enum class DrawScope : std::uint32_t
{
  Split,
  Body,
  Exam,
  Image
};

/// A number's own place in the random stream, by its name: so it stays the same when others are added to a file.
std::uint32_t drawKey(std::string_view name);

/// Uniform in [0, 1), with 52 bits, of a data set's seed, the number of the body, exam or image, and the key; of
/// nothing else (see philox). `index` is at least 0; `attempt` is below 2^16.
double drawUniform(std::uint64_t seed, DrawScope scope, std::int64_t index, std::uint32_t key,
                   std::uint32_t attempt = 0);

/// The same as a seed, 0 to 2^31 - 1, which a person can type into ParaView.
std::uint64_t drawSeed(std::uint64_t seed, DrawScope scope, std::int64_t index, std::uint32_t key);

} // namespace sono
