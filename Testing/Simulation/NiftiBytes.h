#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include <zlib.h>

namespace sono::testing {

/// A NIfTI-1 file put together byte by byte from the standard's offsets, so that the reader under test meets a file
/// that its own writer did not make.
class NiftiBytes
{
public:
  NiftiBytes(std::array<std::int16_t, 8> dim, std::int16_t datatype, std::int16_t bytesPerVoxel)
    : bytes_(352, 0)
  {
    put<std::int32_t>(0, 348);
    for (std::size_t n = 0; n < 8; ++n)
    {
      put<std::int16_t>(40 + 2 * n, dim[n]);
      put<float>(76 + 4 * n, 1.0f); // pixdim
    }
    put<std::int16_t>(70, datatype);
    put<std::int16_t>(72, std::int16_t(8 * bytesPerVoxel));
    put<float>(108, 352.0f); // vox_offset
    bytes_[123] = 2;         // millimetres
    std::memcpy(&bytes_[344], "n+1", 4);
  }

  NiftiBytes& spacing(float x, float y, float z)
  {
    put(80, x);
    put(84, y);
    put(88, z);
    return *this;
  }
  NiftiBytes& scale(float slope, float intercept)
  {
    put(112, slope);
    put(116, intercept);
    return *this;
  }
  NiftiBytes& unit(char code)
  {
    bytes_[123] = code;
    return *this;
  }
  NiftiBytes& sform(const std::array<float, 12>& rows)
  {
    put<std::int16_t>(254, 1);
    std::memcpy(&bytes_[280], rows.data(), sizeof(rows));
    return *this;
  }
  NiftiBytes& qform(const std::array<float, 3>& quaternionBcd, const std::array<float, 3>& offset, float qfac)
  {
    put<std::int16_t>(252, 1);
    std::memcpy(&bytes_[256], quaternionBcd.data(), sizeof(quaternionBcd));
    std::memcpy(&bytes_[268], offset.data(), sizeof(offset));
    put(76, qfac);
    return *this;
  }
  NiftiBytes& extension(std::int32_t code, std::string text)
  {
    text.resize((text.size() + 8 + 15) / 16 * 16 - 8, '\0');
    bytes_[348] = 1;
    append(std::int32_t(text.size() + 8));
    append(code);
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    put(108, float(bytes_.size()));
    return *this;
  }
  template<class T>
  NiftiBytes& voxels(const std::vector<T>& values)
  {
    for (const T value : values)
    {
      append(value);
    }
    return *this;
  }

  void write(const std::string& path) const
  {
    std::ofstream(path, std::ios::binary).write(bytes_.data(), std::streamsize(bytes_.size()));
  }
  void writeGz(const std::string& path) const
  {
    const gzFile file = gzopen(path.c_str(), "wb");
    gzwrite(file, bytes_.data(), unsigned(bytes_.size()));
    gzclose(file);
  }

private:
  template<class T>
  void put(std::size_t offset, T value)
  {
    std::memcpy(&bytes_[offset], &value, sizeof(value));
  }
  template<class T>
  void append(T value)
  {
    const char* raw = reinterpret_cast<const char*>(&value);
    bytes_.insert(bytes_.end(), raw, raw + sizeof(value));
  }

  std::vector<char> bytes_;
};

} // namespace sono::testing
