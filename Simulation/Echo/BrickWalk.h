#pragma once

#include "Echo/BeamSplat.h"
#include "Echo/FieldSight.h"
#include "Kernel/Vec.h"
#include "Probe/ArraySight.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace sono {

/// A beam and the depth to which it is needed.
struct BeamReach
{
  Beam beam;
  float depthMm;                         ///< <= fromMm: not needed at all
  const FieldSight* sight = nullptr;     ///< of the beam's field, for bricks of this size; null when it is a Gaussian
  const BeamReachTable* table = nullptr; ///< of the beam's aperture or array; null when it has none
  const ArraySight* array = nullptr;     ///< of the beam's array; null when it has none
  float fromMm = 0.0f;
  float marginMm = 0.0f; ///< how far outside of its brick a scatterer may lie
  float share = 1.0f;    ///< of a Gaussian's or an aperture's reach to the side, the part that is needed
};

/// Cubic bricks of edge `edgeMm`: brick b fills [b, b + 1) * edgeMm. Those between low and high hold scatterers.
struct BrickGrid
{
  float edgeMm = 1.0f;
  Vec3f lowMm{ 0.0f };
  Vec3f highMm{ 0.0f };
};

/// A row of bricks along an axis of the grid, and which of them the beams of a group may see.
class BrickRow
{
public:
  /// Numbers of bricks in the row, [first, last]; none where last < first.
  struct Span
  {
    int first;
    int last;
  };

  virtual ~BrickRow() = default;
  int count() const { return count_; }
  Vec3i brick(int n) const
  {
    Vec3i brick = first_;
    brick[axis_] += n;
    return brick;
  }
  int axis() const { return axis_; }
  /// Those that a beam of the group may see, by its reach along the row alone.
  const Span& span(std::size_t beam) const { return spans_[beam]; }
  /// Whether it may see one of them.
  virtual bool sees(std::size_t beam, int n) const = 0;

protected:
  Vec3i first_{ 0 };
  int axis_ = 0;
  int count_ = 0;
  std::vector<Span> spans_;
};

/// Calls visit(row) for rows that hold every brick that a beam of the group may see, in a fixed order.
void forBrickRows(const BrickGrid& grid, const std::vector<BeamReach>& group,
                  const std::function<void(const BrickRow&)>& visit);

/// Calls visit(brick, beams) for every brick that a beam of the group may see, in the order of the rows, with the beams
/// that may see it (indices into the group, ascending). Neighbouring beams make a good group: they share their bricks.
void forSeenBricks(const BrickGrid& grid, const std::vector<BeamReach>& group,
                   const std::function<void(const Vec3i&, const std::vector<std::size_t>&)>& visit);

} // namespace sono
