#pragma once

#include "Kernel/Vec.h"
#include "Scene/StepFit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

// The staircase of voxels along four lines through a face, and the widest plane or quadratic that it allows
// (BoundaryFits).

namespace sono::stepfit {

/// A surface by heights over columns, voxels, and how far to each side its steps agree with it.
struct StarFit
{
  Quadratic height;
  int radius = 0; ///< columns; 0: no fit
};

/// Steps of the columns along an axis on both diagonals and both middle lines of a window, as StepMap holds them of all
/// of its columns: a twentieth of the work, and as good where one slope is all that is asked for. A line tells a slope
/// as its window does, by how far the steps reach, not by how many they are.
class StepStar
{
public:
  StepStar(const std::uint8_t* tissues, const Vec3i& size)
    : tissues_(tissues)
    , size_(size)
    , pitch_{ 1, size.x, std::ptrdiff_t(size.x) * size.y }
  {
  }

  /// Of the face above a voxel: the plane of the widest window whose steps all lie within their rounding, or where that
  /// is narrower than `leastOfPlane` columns to each side a quadratic's, of `leastOfBent` at least.
  StarFit fit(const Vec3i& voxel, int axis, float leastOfPlane, float leastOfBent)
  {
    begin(voxel, axis);
    StarFit best;
    for (const int radius : windows)
    {
      StarFit plane{ {}, radius };
      if (!isSeen(radius, leastKnown) || !fitted(3, plane.height))
      {
        break;
      }
      best = plane;
    }
    if (float(best.radius) >= leastOfPlane)
    {
      return best;
    }
    if (best.radius == 0)
    {
      return {}; // rough, or bent too much for the windows to come
    }
    best.radius = 0;
    for (const int radius : windows)
    {
      if (float(radius) < leastOfBent)
      {
        continue;
      }
      StarFit bent{ {}, radius };
      if (!isSeen(radius, leastKnownBent) || !fitted(terms, bent.height))
      {
        break;
      }
      best = bent;
    }
    return best;
  }

private:
  static constexpr std::array<int, 8> windows{ 6, 9, 13, 18, 26, 40, 64, 96 };
  static constexpr int widest = 96;
  static constexpr int lines = 4;
  static constexpr int pitch = 2 * widest + 1;
  static constexpr float leastKnown = 0.6f; ///< of a window's weight, for a plane
  static constexpr float leastKnownBent = 0.9f;
  static constexpr int mostStep = 2; ///< voxels from a column's step to its neighbour's
  /// Voxels that a step may lie further from a fit than half a voxel, its rounding: of one that is taken, and of least
  /// squares that are worth settling; Newton's steps that settle one, and one too small to go on.
  static constexpr float mostExcess = 0.08f;
  static constexpr float hopelessExcess = 0.5f;
  static constexpr int rounds = 6;
  static constexpr float settledStep = 1e-3f; // voxels

  /// Weights of a line's columns in a window: falling to the rim. What of a column's excess counts does so more slowly.
  struct LineWeights
  {
    int reach; ///< columns to each side
    std::vector<float> weight;
    std::vector<float> strictness;
    float total = 0.0f; ///< of the weights

    LineWeights(int radius, int line)
      : reach(line < 2 ? radius : int(std::lround(radius * std::sqrt(0.5))))
    {
      for (int t = -reach; t <= reach; ++t)
      {
        const double r = t / (reach + 1.0);
        const double q = 1.0 - r * r;
        weight.push_back(float(q));
        strictness.push_back(float(std::min(1.0, 2.0 * q)));
        total += weight.back();
      }
    }
  };

  static const LineWeights& weightsOf(int radius, int line)
  {
    static const std::vector<LineWeights> all = [] {
      std::vector<LineWeights> made;
      for (const int window : windows)
      {
        made.emplace_back(window, 0);
        made.emplace_back(window, lines - 1);
      }
      return made;
    }();
    const auto window = std::find(windows.begin(), windows.end(), radius) - windows.begin();
    return all[std::size_t(2 * window + (line < 2 ? 0 : 1))];
  }

  static constexpr int stepU(int line) { return line == 1 ? 0 : 1; }
  static constexpr int stepV(int line) { return line == 0 ? 0 : (line == 3 ? -1 : 1); }

  void begin(const Vec3i& voxel, int axis)
  {
    voxel_ = voxel;
    axis_ = axis;
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const std::ptrdiff_t at = voxel.x + pitch_[1] * voxel.y + pitch_[2] * voxel.z;
    middle_ = tissues_ + at;
    below_ = middle_[0];
    above_ = middle_[pitch_[axis]];
    for (int line = 0; line < lines; ++line)
    {
      height_[line][widest] = 0.0f;
      for (int side = 0; side < 2; ++side)
      {
        Arm& arm = arms_[line][side];
        const int sign = side == 0 ? -1 : 1;
        const int du = sign * stepU(line);
        const int dv = sign * stepV(line);
        const auto room = [&](int a, int d) { return d == 0 ? widest : (d > 0 ? size_[a] - 1 - voxel[a] : voxel[a]); };
        arm.room = std::min({ widest, room(u, du), room(v, dv) });
        arm.pitch = du * pitch_[u] + dv * pitch_[v];
        arm.known = 0;
        arm.step = 0;
      }
    }
  }

  /// A column is known where it has a step from the same tissue to the same other one, near that of its neighbour
  /// further in.
  void gather(int radius)
  {
    for (int line = 0; line < lines; ++line)
    {
      const int reach = weightsOf(radius, line).reach;
      for (int side = 0; side < 2; ++side)
      {
        Arm& arm = arms_[line][side];
        while (arm.known < std::min(reach, arm.room))
        {
          if (!findStep(arm))
          {
            arm.room = arm.known;
            break;
          }
          ++arm.known;
          height_[line][side == 0 ? widest - arm.known : widest + arm.known] = float(arm.step);
        }
      }
    }
  }

  struct Arm
  {
    int room;             ///< columns that there may be
    int known;            ///< columns
    int step;             ///< of the last known one
    std::ptrdiff_t pitch; ///< from a column to the next
  };

  bool findStep(Arm& arm) const
  {
    const std::uint8_t* column = middle_ + (arm.known + 1) * arm.pitch;
    for (int n = 0; n <= 2 * mostStep; ++n)
    {
      const int h = arm.step + ((n & 1) ? (n + 1) / 2 : -n / 2);
      const int place = voxel_[axis_] + h;
      if (place < 0 || place + 1 >= size_[axis_])
      {
        continue;
      }
      const std::uint8_t* t = column + h * pitch_[axis_];
      if (t[0] == below_ && t[pitch_[axis_]] == above_)
      {
        arm.step = h;
        return true;
      }
    }
    return false;
  }

  /// A line's columns in a window, on to whole vectors; weights are 0 where there is no step.
  struct Row
  {
    int reach;
    float height[pitch + lanes];
    float weight[pitch + lanes];
    float strictness[pitch + lanes];
    float stiffness[pitch + lanes];
    float force[pitch + lanes];

    int count() const { return 2 * reach + 1; }
  };

  /// Goes to a window; false where too few of its columns have a step.
  bool isSeen(int radius, float least)
  {
    gather(radius);
    radius_ = radius;
    float known = 0.0f;
    float total = 0.0f;
    for (int line = 0; line < lines; ++line)
    {
      const LineWeights& w = weightsOf(radius, line);
      Row& row = rows_[line];
      row.reach = w.reach;
      const float* from = height_[line] + (widest - w.reach);
      const int first = w.reach - std::min(w.reach, arms_[line][0].known);
      const int last = w.reach + std::min(w.reach, arms_[line][1].known);
      for (int n = 0; n < row.count() + lanes; ++n)
      {
        const bool isKnown = n >= first && n <= last;
        row.height[n] = isKnown ? from[n] : 0.0f;
        row.weight[n] = isKnown ? w.weight[std::size_t(n)] : 0.0f;
        row.strictness[n] = isKnown ? w.strictness[std::size_t(n)] : 0.0f;
        row.stiffness[n] = row.force[n] = 0.0f;
        known += row.weight[n];
      }
      total += w.total;
    }
    return known >= least * total;
  }

  /// A surface's heights along a line.
  static Quadratic along(const Quadratic& q, int line)
  {
    const float a = float(stepU(line));
    const float b = float(stepV(line));
    return { q.c0, a * q.c1 + b * q.c2, 0.0f, a * a * q.c3 + b * b * q.c4 + a * b * q.c5, 0.0f, 0.0f };
  }

  /// The largest distance from a surface beyond a step's rounding, voxels; not much more is looked at than `enough`.
  float excess(const Quadratic& q, float enough) const
  {
    float largest = 0.0f;
    for (int line = 0; line < lines && largest <= enough; ++line)
    {
      const Row& row = rows_[line];
      const Quadratic k = along(q, line);
      Floats most{};
      Floats t;
      countFrom(-float(row.reach), t);
      for (int n = 0; n < row.count(); n += lanes, t += float(lanes))
      {
        Floats h;
        Floats s;
        load(row.height + n, h);
        load(row.strictness + n, s);
        const Floats d = h - (k.c0 + t * (k.c1 + t * k.c3));
        const Floats e = ((d < 0.0f ? -d : d) - 0.5f) * s;
        most = e > most ? e : most;
      }
      largest = std::max(largest, largestOf(most));
    }
    return largest;
  }

  /// The surface of so many terms, 3 or 6, from its least squares' place moved into the middle of what the steps allow
  /// (see pull), round by round; false where they allow none.
  bool fitted(int count, Quadratic& height)
  {
    NormalEquations equations;
    for (int line = 0; line < lines; ++line)
    {
      Row& row = rows_[line];
      for (int n = 0; n < row.count(); ++n)
      {
        row.force[n] = row.weight[n] * row.height[n];
      }
      const RowSums sums(float(-row.reach), row.count(), row.weight, row.force);
      equations.addLine(stepU(line), stepV(line), sums.x, sums.height);
    }
    if (!solved(equations, count, height) || excess(height, hopelessExcess) > hopelessExcess)
    {
      return false;
    }
    for (int n = 0; n < rounds && settle(count, height) > settledStep; ++n)
    {
    }
    return excess(height, mostExcess) <= mostExcess;
  }

  bool solved(const NormalEquations& equations, int count, Quadratic& height)
  {
    equations.sumTo(room_.sums);
    return solve(room_.sums, count, room_, height);
  }

  /// Newton's step, voxels.
  float settle(int count, Quadratic& height)
  {
    NormalEquations equations;
    for (int line = 0; line < lines; ++line)
    {
      Row& row = rows_[line];
      const Shape shape{ along(height, line) };
      Floats t;
      countFrom(float(-row.reach), t);
      for (int n = 0; n < row.count(); n += lanes, t += float(lanes))
      {
        Floats h;
        Floats w;
        Floats stiffness;
        Floats force;
        load(row.height + n, h);
        load(row.weight + n, w);
        pull(shape, t, 0.0f, h, w, stiffness, force);
        store(stiffness, row.stiffness + n);
        store(force, row.force + n);
      }
      const RowSums sums(float(-row.reach), row.count(), row.stiffness, row.force);
      equations.addLine(stepU(line), stepV(line), sums.x, sums.height);
    }
    Quadratic d{};
    if (!solved(equations, count, d))
    {
      return 0.0f;
    }
    add(height, d, 1.0f);
    const float r = float(radius_);
    return std::fabs(d.c0) + r * (std::fabs(d.c1) + std::fabs(d.c2)) +
           r * r * (std::fabs(d.c3) + std::fabs(d.c4) + std::fabs(d.c5));
  }

  const std::uint8_t* tissues_;
  Vec3i size_;
  std::ptrdiff_t pitch_[3];
  Vec3i voxel_{ 0, 0, 0 };
  int axis_ = 0;
  const std::uint8_t* middle_ = nullptr; ///< the voxel below the face
  std::uint8_t below_ = 0;
  std::uint8_t above_ = 0;
  Arm arms_[lines][2];
  float height_[lines][pitch]; ///< steps relative to the face's; what is not known is not read
  int radius_ = 0;             ///< of the window
  Row rows_[lines];            ///< its columns
  EquationRoom room_;
};

} // namespace sono::stepfit
