#pragma once

#include "Kernel/HostDevice.h"
#include "Kernel/Vec.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace sono {

/// A view of the tracer's cache of a region: one 16-bit word per voxel and one record per boundary voxel. The word's
/// low byte is the tissue index. Its high byte is, below 128, the half-width of a cube around the voxel known to hold
/// that tissue alone; else 128 + the voxel's rank among those of its block that have a record. Local millimetres with 0
/// at the region's outer corner. Voxels lie in blocks of 4 x 4 x 2, one cache line of words each, so that a ray in any
/// direction meets about three voxels a line.
struct TissueCells
{
  const std::uint16_t* cell = nullptr;
  const std::uint32_t* firstRecord = nullptr; ///< of each block
  const std::uint32_t* record = nullptr;
  Vec3i size{ 0, 0, 0 };
  Vec3i blocks{ 0, 0, 0 };
  Vec3f spacing{ 1.0f, 1.0f, 1.0f };
  Vec3f perMm{ 1.0f, 1.0f, 1.0f }; ///< 1 / spacing
  float meanSpacing = 1.0f;        ///< cube root of the voxel's volume

  /// With a border of one voxel all around, which holds `outsideWord`: a march needs no other test for the region's
  /// end.
  static Vec3i blocksFor(const Vec3i& size) { return { (size.x + 5) >> 2, (size.y + 5) >> 2, (size.z + 3) >> 1 }; }
  static constexpr std::uint16_t outsideWord = 255;
  SONO_HD std::size_t offset(const Vec3i& c) const { return offset(c.x, c.y, c.z); }
  /// For -1 <= x <= size.x, and so on.
  SONO_HD std::size_t offset(int x, int y, int z) const
  {
    const unsigned ux = unsigned(x + 1);
    const unsigned uy = unsigned(y + 1);
    const unsigned uz = unsigned(z + 1);
    const unsigned block = (ux >> 2) + unsigned(blocks.x) * ((uy >> 2) + unsigned(blocks.y) * (uz >> 1));
    return (std::size_t(block) << 5) | ((ux & 3u) | ((uy & 3u) << 2) | ((uz & 1u) << 4));
  }
  /// Of the eight voxels from `low` to the next along each axis, x first: each axis adds its own part.
  SONO_HD void offsetsAround(const Vec3i& low, std::size_t* out) const
  {
    const std::size_t perRow = std::size_t(blocks.x) << 5;
    const std::size_t perSlab = perRow * std::size_t(blocks.y);
    const auto ofX = [](unsigned u) { return (std::size_t(u >> 2) << 5) | (u & 3u); };
    const auto ofY = [=](unsigned u) { return std::size_t(u >> 2) * perRow + ((u & 3u) << 2); };
    const auto ofZ = [=](unsigned u) { return std::size_t(u >> 1) * perSlab + ((u & 1u) << 4); };
    const std::size_t x[2] = { ofX(unsigned(low.x + 1)), ofX(unsigned(low.x + 2)) };
    const std::size_t y[2] = { ofY(unsigned(low.y + 1)), ofY(unsigned(low.y + 2)) };
    const std::size_t z[2] = { ofZ(unsigned(low.z + 1)), ofZ(unsigned(low.z + 2)) };
    for (int n = 0; n < 8; ++n)
    {
      out[n] = x[n & 1] + y[(n >> 1) & 1] + z[n >> 2];
    }
  }
  SONO_HD std::uint32_t wordAt(int x, int y, int z) const { return cell[offset(x, y, z)]; }
  /// The record of the voxel, whose word is given; 0 where it has none.
  SONO_HD std::uint32_t recordOf(int x, int y, int z, std::uint32_t word) const
  {
    return (word & 0x8000u) ? record[firstRecord[offset(x, y, z) >> 5] + ((word >> 8) & 31u)] : 0u;
  }
  SONO_HD bool contains(const Vec3i& c) const
  {
    return unsigned(c.x) < unsigned(size.x) && unsigned(c.y) < unsigned(size.y) && unsigned(c.z) < unsigned(size.z);
  }
  SONO_HD int tissueAt(const Vec3i& c) const { return int(wordAt(c.x, c.y, c.z) & 255u); }
  SONO_HD Vec3i cellAt(const Vec3f& position) const
  {
    const Vec3f p = position / spacing;
    return Vec3i(int(floorf(p.x)), int(floorf(p.y)), int(floorf(p.z)));
  }

  /// A place among the words that a march moves from cell to cell.
  class Cursor
  {
  public:
    SONO_HD Cursor(const TissueCells& cells, const Vec3i& cell, const Vec3i& sign)
      : cells_(cells)
      , cell_(cell)
      , sign_(sign)
    {
    }
    /// To the neighbour along one axis, in the sense of its sign.
    SONO_HD void move(bool alongX, bool alongY, bool alongZ)
    {
      cell_.x += alongX ? sign_.x : 0;
      cell_.y += alongY ? sign_.y : 0;
      cell_.z += alongZ ? sign_.z : 0;
    }
    SONO_HD void jump(const Vec3i& cell) { cell_ = cell; }
    SONO_HD std::uint32_t word() const { return cells_.wordAt(cell_.x, cell_.y, cell_.z); }

  private:
    const TissueCells& cells_;
    Vec3i cell_;
    Vec3i sign_;
  };
};

/// The same with the words row after row, border included: a step is one addition. A GPU, which computes addresses and
/// waits for memory with the same threads, is faster with them; a CPU with the blocks.
struct RowCells : TissueCells
{
  const std::uint16_t* words = nullptr;
  Vec3i pitch{ 0, 0, 0 }; ///< words from a voxel to the next along each axis

  /// (size.x + 2) x (size.y + 2) x (size.z + 2) words.
  static Vec3i pitchFor(const Vec3i& size) { return { 1, size.x + 2, (size.x + 2) * (size.y + 2) }; }
  SONO_HD std::size_t rowOffset(int x, int y, int z) const
  {
    return std::size_t(x + 1) + std::size_t(y + 1) * std::size_t(pitch.y) + std::size_t(z + 1) * std::size_t(pitch.z);
  }
  SONO_HD std::uint32_t wordAt(int x, int y, int z) const { return words[rowOffset(x, y, z)]; }
  SONO_HD int tissueAt(const Vec3i& c) const { return int(wordAt(c.x, c.y, c.z) & 255u); }

  class Cursor
  {
  public:
    SONO_HD Cursor(const RowCells& cells, const Vec3i& cell, const Vec3i& sign)
      : cells_(cells)
      , at_(cells.words + cells.rowOffset(cell.x, cell.y, cell.z))
      , stepX_(sign.x)
      , stepY_(sign.y * cells.pitch.y)
      , stepZ_(sign.z * cells.pitch.z)
    {
    }
    SONO_HD void move(bool alongX, bool alongY, bool) { at_ += alongX ? stepX_ : (alongY ? stepY_ : stepZ_); }
    SONO_HD void jump(const Vec3i& cell) { at_ = cells_.words + cells_.rowOffset(cell.x, cell.y, cell.z); }
    SONO_HD std::uint32_t word() const { return *at_; }

  private:
    const RowCells& cells_;
    const std::uint16_t* at_;
    int stepX_;
    int stepY_;
    int stepZ_;
  };
};

} // namespace sono
