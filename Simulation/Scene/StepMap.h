#pragma once

#include "Kernel/Vec.h"
#include "Scene/StepFit.h"
#include "Scene/StepWindows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

// The staircase of voxels around a face, and the smoothest surface that it allows (SurfacePieces).

namespace sono::stepfit {
inline namespace SONO_LANES_NAMESPACE {

constexpr int widestBent = 24; // the terraces of a slope of a degree are wider, those of what is bent are not
constexpr int allColumns = 2 * widest + 1;
constexpr std::size_t windowCount = 8;
/// Voxels to each side.
SONO_LANES inline int windowRadius(std::size_t window)
{
  constexpr int radii[windowCount] = { 2, 3, 5, 8, 12, 17, 24, widest };
  return radii[window];
}
/// Voxels that a column's step may lie further from a fit than half a voxel, a step's rounding: up to the first a
/// window counts fully, from the second on not at all.
constexpr float freeExcess = 0.05f;
constexpr float mostExcess = 0.15f;
/// The same of a least-squares fit that is not worth settling; Newton's steps that settle one, and one too small to
/// go on.
constexpr float hopelessExcess = 0.25f;
constexpr int rounds = 2;
constexpr float settledStep = 1e-3f; // voxels
/// A window needs this share of its columns, and that to count fully.
constexpr float fewestSeen = 0.5f;
constexpr float enoughSeen = 0.75f;
constexpr std::int8_t unknown = -128; // step of a column outside of the volume
constexpr int mostStep = 2;           // voxels from a column's step to its neighbour's

/// Steps of the columns around a face, relative to its own: how many voxels along the axis they lie further.
class StepMap
{
public:
  /// `windows` by radius.
  SONO_LANES StepMap(const std::uint8_t* tissues, const Vec3i& size, const Window* windows)
    : tissues_(tissues)
    , size_(size)
    , window_(windows)
    , pitch_{ 1, size.x, std::ptrdiff_t(size.x) * size.y }
  {
  }

  SONO_LANES std::uint8_t at(const Vec3i& v) const { return tissues_[v.x + pitch_[1] * v.y + pitch_[2] * v.z]; }
  SONO_LANES bool contains(const Vec3i& v) const
  {
    return unsigned(v.x) < unsigned(size_.x) && unsigned(v.y) < unsigned(size_.y) && unsigned(v.z) < unsigned(size_.z);
  }

  /// Fills the rings [first, last] around the face above `voxel`, those before them being filled: a column is known
  /// where it has a step from the same tissue to the same other one, near that of its neighbour further in.
  SONO_LANES_CALLED void gather(const Vec3i& voxel, int axis, int first, int last)
  {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const std::uint8_t below = at(voxel);
    Vec3i next = voxel;
    ++next[axis];
    const std::uint8_t above = at(next);
    const std::ptrdiff_t pitchU = pitch_[u];
    const std::ptrdiff_t pitchV = pitch_[v];
    const std::ptrdiff_t pitchAlong = pitch_[axis];
    const std::uint8_t* const middle = tissues_ + voxel.x + pitch_[1] * voxel.y + pitch_[2] * voxel.z;
    const int lowest = -voxel[axis];
    const int highest = size_[axis] - 2 - voxel[axis];
    for (int r = first; r <= last; ++r)
    {
      const bool isInside = voxel[u] >= r && voxel[u] + r < size_[u] && voxel[v] >= r && voxel[v] + r < size_[v];
      // The ring's places, side by side.
      forCells(4, 2 * r, [&](int side, int place) {
        const int n = place - r;
        const int i = side == 0 ? n : (side == 1 ? r : (side == 2 ? -n : -r));
        const int j = side == 0 ? -r : (side == 1 ? n : (side == 2 ? r : -n));
        std::int8_t& own = step(i, j);
        own = unknown;
        const int from = step(std::max(1 - r, std::min(i, r - 1)), std::max(1 - r, std::min(j, r - 1)));
        if (from == unknown || (!isInside && (unsigned(voxel[u] + i) >= unsigned(size_[u]) ||
                                              unsigned(voxel[v] + j) >= unsigned(size_[v]))))
        {
          return;
        }
        const std::uint8_t* const column = middle + i * pitchU + j * pitchV;
        for (int n = 0; n <= 2 * mostStep; ++n)
        {
          const int h = from + ((n & 1) ? (n + 1) / 2 : -n / 2);
          const std::uint8_t* t = column + h * pitchAlong;
          if (h >= lowest && h <= highest && t[0] == below && t[pitchAlong] == above)
          {
            own = std::int8_t(h);
            return;
          }
        }
      });
    }
  }

  /// The smoothest surface that the labels allow; false where they show none.
  SONO_LANES bool smoothest(const Vec3i& voxel, int axis, const Vec3f& spacing, Quadratic& out)
  {
    step(0, 0) = 0;
    const float u = spacing[(axis + 1) % 3] / spacing[axis];
    const float v = spacing[(axis + 2) % 3] / spacing[axis];
    std::array<float, windowCount> seen{};
    std::array<Start, windowCount> starts{};
    std::size_t count = 0;
    int gathered = 0;
    int misses = 0;
    bool isFlat = true;
    for (; count < windowCount && misses < 2 && (isFlat || windowRadius(count) <= widestBent); ++count)
    {
      const int radius = windowRadius(count);
      gather(voxel, axis, gathered + 1, radius);
      gathered = radius;
      sumSteps(radius, sums_[count]);
      const double known = sums_[count][0] / double(window_[radius].total);
      seen[count] = smoothStep(fewestSeen, enoughSeen, float(known));
      if (!(seen[count] > 0.0f) || !leastSquares(radius, u, v, sums_[count], starts[count]))
      {
        break;
      }
      isFlat = starts[count].kind == Kind::Plane;
      misses = starts[count].kind != Kind::None ? 0 : misses + (radius < 8 ? 1 : 2);
    }
    if (count == 0)
    {
      return false;
    }
    // Each window in front of those within it as far as it agrees: all is continuous along the surface.
    out = {};
    float left = 1.0f;
    for (std::size_t w = count; w-- > 0 && left > 0.0f;)
    {
      if (w == 0 || starts[w].kind != Kind::None)
      {
        Quadratic fit;
        const float agreement = settle(windowRadius(w), u, v, sums_[w], starts[w], fit);
        const float share = w == 0 ? left : left * seen[w] * agreement;
        if (share > 0.0f)
        {
          add(out, fit, share);
          left -= share;
        }
      }
    }
    return true;
  }

private:
  enum class Kind
  {
    Plane,
    Ball,
    Bent,
    None
  };

  /// The smoothest shape whose least squares lie near enough to the steps to be settled; of none, the last.
  struct Start
  {
    Shape shape;
    Kind kind;
  };

  /// By the sums of a quadratic's equations. False where there are too few data.
  SONO_LANES bool leastSquares(int radius, float u, float v, const double* sums, Start& start)
  {
    Shape plane{};
    if (!solve(sums, 3, room_, plane.q))
    {
      return false;
    }
    start.shape = plane;
    start.kind = Kind::Plane;
    if (isNear(start.shape, radius))
    {
      return true;
    }
    start.kind = Kind::Ball;
    if (fitBall(radius, u, v, start.shape) && isNear(start.shape, radius))
    {
      return true;
    }
    start.shape = {};
    start.kind = Kind::None;
    if (!solve(sums, terms, room_, start.shape.q))
    {
      start.shape = plane;
    }
    else if (isNear(start.shape, radius))
    {
      start.kind = Kind::Bent;
    }
    return true;
  }

  SONO_LANES bool isNear(const Shape& shape, int radius)
  {
    return excess(shape, radius, hopelessExcess) < hopelessExcess;
  }

  /// The smoothest of plane, ball and quadratic, each in front of the next as far as it agrees; how well they do.
  SONO_LANES_CALLED float settle(int radius, float u, float v, const double* sums, const Start& start, Quadratic& out)
  {
    Shape shape = start.shape;
    out = shape.q;
    float agreement = 0.0f;
    if (start.kind == Kind::None)
    {
      return agreement;
    }
    if (start.kind == Kind::Plane)
    {
      agreement = settled(radius, shape, [&] { return settleQuadratic(radius, 3, shape); });
      out = shape.q;
    }
    if (start.kind == Kind::Ball ||
        (start.kind == Kind::Plane && agreement < 1.0f && fitBall(radius, u, v, shape) && isNear(shape, radius)))
    {
      const float ballAgrees = settled(radius, shape, [&] { return settleBall(radius, u, v, shape); });
      if (ballAgrees > 0.0f)
      {
        out = agreement > 0.0f ? mix(shape.osculating(), out, agreement) : shape.osculating();
        agreement = std::max(agreement, ballAgrees);
      }
    }
    Shape bent{};
    if (agreement < 1.0f && solve(sums, terms, room_, bent.q))
    {
      const float bentAgrees =
        isNear(bent, radius) ? settled(radius, bent, [&] { return settleQuadratic(radius, terms, bent); }) : 0.0f;
      out = mix(bent.q, out, agreement);
      agreement = std::max(agreement, bentAgrees);
    }
    return agreement;
  }

  /// Moves a shape from the least squares' place into the middle of what the steps allow, round by round, and tells how
  /// well it agrees.
  template<class F>
  SONO_LANES float settled(int radius, const Shape& shape, const F& round)
  {
    for (int n = 0; n < rounds && round() > settledStep; ++n)
    {
    }
    return agrees(shape, radius);
  }

  /// Calls f(x, first) for the window's columns, as many at a time as there are lanes: from `first` on, each lane's at
  /// its x. They may go on beyond the window.
  template<class F>
  SONO_LANES static void forStrips(int radius, const F& f)
  {
    for (int first = -radius; first <= radius; first += lanes)
    {
      Floats x;
      countFrom(float(first), x);
      f(x, first);
    }
  }

  /// Steps of a strip's columns in a row, and their weights, which are 0 where there is none and beyond the window.
  SONO_LANES void load(int radius, const Floats& x, int first, int j, Floats& height, Floats& weight) const
  {
    stepfit::load(stepsOf(first, j), height);
    stepfit::load(window_[radius].weight + (2 * radius + 1) * (j + radius) + first + radius, weight);
    const Floats none{};
    const auto isKnown = (x <= float(radius)) & (height != float(unknown));
    height = isKnown ? height : none;
    weight = isKnown ? weight : none;
  }

  /// Puts a window into equations, column by column: add(sums, x, y, height, weight) for the steps of a strip in each
  /// of its rows, to sums that begin as `none`.
  template<class Sums, class Equations, class Add>
  SONO_LANES void addWindow(int radius, const Sums& none, const Add& add, Equations& equations) const
  {
    forStrips(radius, [&](const Floats& x, int first) {
      Sums sums = none;
      SONO_ROLLED
      for (int j = -radius; j <= radius; ++j)
      {
        Floats height;
        Floats weight;
        load(radius, x, first, j, height, weight);
        add(sums, x, float(j), height, weight);
      }
      equations.addColumns(x, sums);
    });
  }

  /// Newton's step, voxels, towards the least of a barrier that keeps each step within its rounding.
  SONO_LANES_CALLED float settleQuadratic(int radius, int count, Shape& shape)
  {
    NormalEquations equations;
    const Shape from = shape;
    const auto addPull = [&](ColumnSums& sums, const Floats& x, float y, const Floats& height, const Floats& weight) {
      Floats stiffness;
      Floats force;
      pull(from, x, y, height, weight, stiffness, force);
      sums.add(y, stiffness, force);
    };
    addWindow(radius, ColumnSums(), addPull, equations);
    equations.sumTo(room_.sums);
    Quadratic d{};
    if (!solve(room_.sums, count, room_, d))
    {
      return 0.0f;
    }
    add(shape.q, d, 1.0f);
    return stepOf(d, radius);
  }

  SONO_LANES static float stepOf(const Quadratic& d, int radius)
  {
    const float r = float(radius);
    return std::fabs(d.c0) + r * (std::fabs(d.c1) + std::fabs(d.c2)) +
           r * r * (std::fabs(d.c3) + std::fabs(d.c4) + std::fabs(d.c5));
  }

  SONO_LANES_CALLED bool fitBall(int radius, float u, float v, Shape& ball)
  {
    BallEquations equations(u, v);
    const auto addStep = [](BallEquations::Columns& sums, const Floats&, float y, const Floats& height,
                            const Floats& weight) { sums.add(y, height, weight, weight * height); };
    addWindow(radius, BallEquations::Columns(v), addStep, equations);
    return equations.solve(room_, ball);
  }

  SONO_LANES_CALLED float settleBall(int radius, float u, float v, Shape& ball)
  {
    BallEquations equations(u, v);
    const Shape from = ball;
    const auto addPull = [&](BallEquations::Columns& sums, const Floats& x, float y, const Floats& height,
                             const Floats& weight) {
      Floats stiffness;
      Floats force;
      pull(from, x, y, height, weight, stiffness, force);
      sums.add(y, height, stiffness, force);
    };
    addWindow(radius, BallEquations::Columns(v), addPull, equations);
    Shape d{};
    if (!equations.solve(room_, d))
    {
      return 0.0f;
    }
    add(ball.q, d.q, 1.0f);
    ball.bulge += d.bulge;
    return stepOf(d.q, radius);
  }

  /// Least squares of the steps alone.
  SONO_LANES_CALLED void sumSteps(int radius, double* sums)
  {
    NormalEquations equations;
    const auto addStep = [](ColumnSums& sums, const Floats&, float y, const Floats& height, const Floats& weight) {
      sums.add(y, weight, weight * height);
    };
    addWindow(radius, ColumnSums(), addStep, equations);
    equations.sumTo(sums);
  }

  /// 1 where no column's step lies further from the fit than its rounding, less to 0 where one does; smoothly.
  SONO_LANES float agrees(const Shape& shape, int radius)
  {
    return 1.0f - smoothStep(freeExcess, mostExcess, excess(shape, radius, mostExcess));
  }

  /// The largest distance from the fit beyond a step's rounding, voxels; not much more is looked at than `enough`.
  SONO_LANES_CALLED float excess(const Shape& shape, int radius, float enough)
  {
    const int pitch = 2 * radius + 1;
    const Shape from = shape;
    const Floats none{};
    Floats largest{};
    SONO_ROLLED
    for (int n = 0; n < pitch; ++n)
    {
      const int j = (n & 1) ? -(n + 1) / 2 : n / 2; // the middle first, where most misfits show
      const float k0 = from.q.at(0.0f, float(j));
      const float k1 = from.q.c1 + from.q.c5 * float(j);
      const float k2 = from.q.c3;
      forStrips(radius, [&](const Floats& x, int first) {
        Floats height;
        Floats strictness;
        stepfit::load(stepsOf(first, j), height);
        stepfit::load(window_[radius].strictness + pitch * (j + radius) + first + radius, strictness);
        const Floats k = k0 + x * (k1 + x * k2);
        Floats z = k;
        if (from.bulge != 0.0f)
        {
          const Floats square = 1.0f - 4.0f * from.bulge * k;
          Floats root;
          rootOf(square > none ? square : none, root);
          z = 2.0f * k / (1.0f + root);
        }
        const Floats off = height - z;
        const Floats e = ((off < none ? -off : off) - 0.5f) * strictness;
        const auto counts = (x <= float(radius)) & (height != float(unknown)) & (e > largest);
        largest = counts ? e : largest;
      });
      if ((n & 7) == 7 && largestOf(largest) >= enough)
      {
        break;
      }
    }
    return largestOf(largest);
  }

  SONO_LANES static std::size_t indexOf(int i, int j) { return std::size_t(i + widest + allColumns * (j + widest)); }
  SONO_LANES std::int8_t& step(int i, int j) { return steps_[indexOf(i, j)]; }
  /// Of a row, from a column on.
  SONO_LANES const std::int8_t* stepsOf(int i, int j) const { return &steps_[indexOf(i, j)]; }

  const std::uint8_t* tissues_;
  Vec3i size_;
  const Window* window_; ///< by radius
  std::ptrdiff_t pitch_[3];
  /// What has not been gathered counts for nothing; there is as much behind the last as a strip goes beyond a window.
  std::array<std::int8_t, std::size_t(allColumns) * allColumns + lanes> steps_;
  double sums_[windowCount][quadraticSums]; ///< of each window's least squares
  EquationRoom room_;
};

} // namespace SONO_LANES_NAMESPACE
} // namespace sono::stepfit
