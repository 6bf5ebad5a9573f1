#pragma once

#include "Echo/BrickWalk.h"
#include "Echo/NestedScatterers.h"
#include "Echo/ScattererView.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sono {

/// What a beam takes of bricks of one level: meet() its rows, then share(), then hear() what was made of them.
class NestedShares
{
public:
  void clear() { met_ = taken_ = 0; }
  /// Those of a row that beam number `index` of the walk's group may see. `before` others lie in front of the row's
  /// among the bricks.
  void meet(const Beam& beam, std::size_t index, const BrickRow& row, int before, const DensityView& density,
            int level);
  /// Decides what the beam takes of those that it has met; raises `wanted`, by brick, to as many candidates.
  void share(const Beam& beam, int level, int* wanted);
  bool takesAny() const { return taken_ > 0; }
  /// The scatterers that the beam takes, with the amplitudes that it hears along its axis.
  ScattererView hear(const NestedScatterers::Generated& scatterers, const Vec3f& axis);

private:
  int met_ = 0;
  int taken_ = 0;
  int candidates_ = 0; ///< of those that are taken
  // Of those that are met, up to whole vectors, of which those that are taken are left.
  std::vector<std::int32_t> brick_;         // among all
  std::vector<std::int32_t> count_, whole_; // of each brick's share, see NestedShare
  std::vector<float> scale_, faded_;        // of the whole ones, and of those that fade
  // On the way there: a brick's place, then its weight, there and at most; what is needed there, 0 where another level
  // gives it.
  std::vector<float> depthMm_, lateralMm_, elevationalMm_, perMm3_;
  std::vector<std::int32_t> at_, parentAt_;
  // What is heard, with room up to whole vectors.
  std::vector<float> x_, y_, z_, amplitude_;
  std::vector<float> alongAxis_; // amplitudes of bricks with fibres as they are heard along the beam's axis
};

} // namespace sono
