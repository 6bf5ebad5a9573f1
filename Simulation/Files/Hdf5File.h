#pragma once

#include "Core/WholeFile.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sono {

/// An HDF5 file that is written, whole or not at all. Groups and arrays are named by their path ("scan/t0_delays");
/// groups on the way are made. Everything throws Error naming the file where it cannot be written.
class Hdf5File
{
public:
  /// Asks first whether there is room for so many floats: HDF5 itself, once it was refused some, may end the program as
  /// that ends.
  Hdf5File(const std::string& path, std::uint64_t floatCount);
  ~Hdf5File();

  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  using Shape = std::vector<std::uint64_t>; ///< slowest first; empty: a scalar

  void group(const std::string& name);
  void floats(const std::string& name, const Shape& shape, const std::vector<float>& values);
  void number(const std::string& name, double value) { floats(name, {}, { float(value) }); }
  void text(const std::string& name, const std::string& value);
  void texts(const std::string& name, const std::vector<std::string>& values);
  /// Characters as 16-bit numbers, as MATLAB keeps them.
  void codes(const std::string& name, const std::string& value);

  /// An array of `shape` in parts along its first axis, each compressed by itself; then the parts, in any order.
  void announce(const std::string& name, const Shape& shape);
  void part(const std::string& name, std::uint64_t index, const std::vector<float>& values);

  /// Attributes of a group or an array; of the file, where `name` is "/".
  void attribute(const std::string& name, const std::string& key, const std::string& value);
  void numbers(const std::string& name, const std::string& key, const std::vector<std::int32_t>& values);

  /// Throws Error where the disk is full.
  void finish();

private:
  [[noreturn]] void refuse() const;
  void require(bool ok) const;

  std::string path_;
  WholeFile whole_;
  std::int64_t file_ = -1;
};

} // namespace sono
