#include "Scene/FaceColumns.h"

#include "Core/Simd.h"

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace sono {

namespace {

// Not wider than AVX2's: the compiler keeps what is wider on the stack there, which takes several times as long.
constexpr int lanes = 8;
using Bytes = std::int8_t __attribute__((vector_size(lanes)));
using Masks = std::int32_t __attribute__((vector_size(4 * lanes)));
using Sums = float __attribute__((vector_size(4 * lanes)));

inline void load(const std::uint8_t* from, Bytes& to)
{
  std::memcpy(&to, from, sizeof to);
}

inline bool isAny(const Bytes& mask)
{
  std::uint64_t bits = 0;
  std::memcpy(&bits, &mask, sizeof mask);
  return bits != 0;
}

/// The weight where the mask's byte is set.
inline void addWhere(const Bytes& mask, const Masks& weight, Sums& sum)
{
  sum += (Sums)(__builtin_convertvector(mask, Masks) & weight);
}

/// Of the columns from `column` on, as many as there are lanes.
SONO_SIMD_CLONES __attribute__((flatten)) void addColumns(const std::uint8_t* corner, const std::ptrdiff_t* pitch,
                                                          std::uint8_t tissue, const Vec3i& count, const float* weightY,
                                                          const float* weightZ, int column, FaceColumns& to)
{
  const Bytes wanted = Bytes{} + std::int8_t(tissue);
  Sums toward[3]{};
  Sums away[3]{};
  for (int k = 0; k < count.z; ++k)
  {
    for (int j = 0; j < count.y; ++j)
    {
      const std::uint8_t* row = corner + column + pitch[1] * j + pitch[2] * k;
      Bytes own;
      load(row, own);
      const Bytes isOwn = own == wanted;
      if (!isAny(isOwn))
      {
        continue; // most rows, of a thin wall
      }
      const Sums weights = Sums{} + weightY[j] * weightZ[k];
      const Masks weight = (Masks)weights;
      for (int a = 0; a < 3; ++a)
      {
        Bytes next;
        Bytes before;
        load(row + pitch[a], next);
        load(row - pitch[a], before);
        addWhere(isOwn & (next != wanted), weight, toward[a]);
        addWhere(isOwn & (before != wanted), weight, away[a]);
      }
    }
  }
  for (int a = 0; a < 3; ++a)
  {
    std::memcpy(to.toward[a] + column, &toward[a], sizeof toward[a]);
    std::memcpy(to.away[a] + column, &away[a], sizeof away[a]);
  }
}

void addRows(const std::uint8_t* corner, const std::ptrdiff_t* pitch, std::uint8_t tissue, const Vec3i& count,
             const float* weightY, const float* weightZ, FaceColumns& to)
{
  to = {};
  for (int k = 0; k < count.z; ++k)
  {
    for (int j = 0; j < count.y; ++j)
    {
      const std::uint8_t* row = corner + pitch[1] * j + pitch[2] * k;
      for (int i = 0; i < count.x; ++i)
      {
        for (int a = 0; a < 3 && row[i] == tissue; ++a)
        {
          to.toward[a][i] += row[i + pitch[a]] != tissue ? weightY[j] * weightZ[k] : 0.0f;
          to.away[a][i] += row[i - pitch[a]] != tissue ? weightY[j] * weightZ[k] : 0.0f;
        }
      }
    }
  }
}

} // namespace

void sumFaces(const std::uint8_t* corner, const Vec3i& size, std::uint8_t tissue, const Vec3i& count,
              const float* weightY, const float* weightZ, FaceColumns& to)
{
  const std::ptrdiff_t pitch[3] = { 1, size.x, std::ptrdiff_t(size.x) * size.y };
  // The box's last row is not the volume's: a whole vector of it ends in the volume, unless that is narrower.
  if (size.x > FaceColumns::most)
  {
    for (int column = 0; column < count.x; column += lanes)
    {
      addColumns(corner, pitch, tissue, count, weightY, weightZ, column, to);
    }
  }
  else
  {
    addRows(corner, pitch, tissue, count, weightY, weightZ, to);
  }
}

} // namespace sono
