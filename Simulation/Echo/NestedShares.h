#pragma once

#include "Echo/BrickWalk.h"
#include "Echo/NestedScatterers.h"
#include "Echo/ScattererView.h"

#include <cstdint>
#include <vector>

namespace sono {

/// What a beam takes of a row's bricks.
class NestedShares
{
public:
  /// Bricks [first, last] of the row that it takes any candidates from; none where last < first.
  int first() const { return first_; }
  int last() const { return last_; }
  /// Candidates that it takes of a brick in between.
  int count(int brick) const { return count_[std::size_t(brick)]; }

  /// Of the bricks of a level, by `density`, that beam number `index` of the walk's group may see.
  void look(const Beam& beam, std::size_t index, const BrickRow& row, const DensityView& density, int level);
  /// The scatterers of the row that the beam takes, with the amplitudes that it hears along its axis.
  ScattererView hear(const NestedScatterers::Row& row, const Vec3f& axis);

private:
  void resize(std::size_t bricks);

  int first_ = 0;
  int last_ = -1;
  std::vector<std::int32_t> count_, whole_; // of each brick's share, see NestedShare
  std::vector<float> scale_, faded_;        // of the whole ones, and of those that fade
  // On the way there: a brick's place, and what is needed there, 0 where another level gives it.
  std::vector<float> depthMm_, lateralMm_, elevationalMm_, perMm3_;
  std::vector<std::int32_t> at_, parentAt_;
  // What is heard, with room up to whole vectors.
  std::vector<float> x_, y_, z_, amplitude_, fibreX_, fibreY_, fibreZ_;
};

} // namespace sono
