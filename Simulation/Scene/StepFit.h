#pragma once

#include "Scene/Lanes.h"

#include <algorithm>
#include <cmath>

// Fits of planes, balls and quadratics to a staircase's heights, voxels (StepMap): by least squares, and then
// into the middle of what the rounding of the steps allows.

namespace sono::stepfit {
inline namespace SONO_LANES_NAMESPACE {

/// Sums of weight x^n, and of weight height x^n.
struct RowSums
{
  double x[5];
  double height[3];

  /// Of `count` places from `first` on, a step of 1 apart: weights, and products of weight and height. The arrays go on
  /// to a multiple of `lanes` with weights of 0.
  SONO_LANES_CALLED RowSums(float first, int count, const float* weight, const float* weighted)
  {
    Floats s[8] = {};
    Floats at;
    countFrom(first, at);
    for (int n = 0; n < count; n += lanes, at += float(lanes))
    {
      Floats w;
      Floats wh;
      load(weight + n, w);
      load(weighted + n, wh);
      const Floats square = at * at;
      const Floats w2 = w * square;
      s[0] += w;
      s[1] += w * at;
      s[2] += w2;
      s[3] += w2 * at;
      s[4] += w2 * square;
      s[5] += wh;
      s[6] += wh * at;
      s[7] += wh * square;
    }
    for (int i = 0; i < 8; ++i)
    {
      (i < 5 ? x[i] : height[i - 5]) = sumOf(s[i]);
    }
  }
};

/// Of columns of cells, a lane's, row by row: sums of weight y^n, and of weight height y^n.
struct ColumnSums
{
  Floats y[5] = {};
  Floats height[3] = {};

  SONO_LANES void add(float at, const Floats& w, const Floats& wh)
  {
    const Floats w1 = w * at;
    const Floats w2 = w1 * at;
    const Floats w3 = w2 * at;
    const Floats wh1 = wh * at;
    y[0] += w;
    y[1] += w1;
    y[2] += w2;
    y[3] += w3;
    y[4] += w3 * at;
    height[0] += wh;
    height[1] += wh1;
    height[2] += wh1 * at;
  }
};

/// c0 + c1 i + c2 j + c3 i^2 + c4 j^2 + c5 i j, voxels.
struct Quadratic
{
  float c0, c1, c2, c3, c4, c5;
  SONO_LANES float at(float i, float j) const { return c0 + c1 * i + c2 * j + c3 * i * i + c4 * j * j + c5 * i * j; }
};

constexpr int terms = 6;
constexpr int moments = 15;
constexpr int quadraticSums = moments + terms;
constexpr int ballSums = 14;

/// Where equations are solved, in memory that lanes share.
struct EquationRoom
{
  double sums[quadraticSums];
  double rows[terms * (terms + 2)]; ///< of a matrix, each with its right-hand side and the least that its pivot may be
};

/// Solves equations of a positive definite matrix, without pivoting: what is asked for stands where the right-hand
/// sides did. False where the data do not tell it.
SONO_LANES_CALLED inline bool eliminate(int count, double* rows)
{
  const int pitch = count + 2;
  SONO_ROLLED
  for (int r = 0; r < count; ++r)
  {
    double* const row = rows + r * pitch;
    if (!(row[r] > row[count + 1]))
    {
      return false;
    }
    const double inverse = 1.0 / row[r];
    forCells(count - 1, count - r, [&](int other, int column) {
      double* const changed = rows + (other < r ? other : other + 1) * pitch;
      const int c = r + 1 + column;
      changed[c] -= changed[r] * inverse * row[c];
    });
  }
  forEach(count, [&](int r) { rows[r * pitch + count] /= rows[r * pitch + r]; });
  return true;
}

/// Normal equations of a quadratic's weighted least squares.
class NormalEquations
{
public:
  /// Data in columns at these x.
  SONO_LANES void addColumns(const Floats& x, const ColumnSums& sums)
  {
    forNumbers([&](int n) {
      const double x1 = numberOf(x, n);
      const double x2 = x1 * x1;
      double y[5];
      double height[3];
      for (int i = 0; i < 5; ++i)
      {
        y[i] = numberOf(sums.y[i], n);
      }
      for (int i = 0; i < 3; ++i)
      {
        height[i] = numberOf(sums.height[i], n);
      }
      const double m[quadraticSums] = { y[0],           x1 * y[0],      y[1],      x2 * y[0],      x1 * y[1],
                                        y[2],           x2 * x1 * y[0], x2 * y[1], x1 * y[2],      y[3],
                                        x2 * x2 * y[0], x2 * x1 * y[1], x2 * y[2], x1 * y[3],      y[4],
                                        height[0],      x1 * height[0], height[1], x2 * height[0], x1 * height[1],
                                        height[2] };
      for (int i = 0; i < quadraticSums; ++i)
      {
        part_[i] += m[i];
      }
    });
  }

  /// Data on the line (x, y) = (a, b) t: sums of weight t^n, n = 0 to 4, and of weight height t^n, n = 0 to 2.
  SONO_LANES void addLine(double a, double b, const double* t, const double* height)
  {
    const double ofA[5] = { 1.0, a, a * a, a * a * a, a * a * a * a };
    const double ofB[5] = { 1.0, b, b * b, b * b * b, b * b * b * b };
    int term = 0;
    for (int degree = 0; degree <= 4; ++degree)
    {
      for (int n = 0; n <= degree; ++n, ++term) // by rising powers of y
      {
        const double factor = ofA[degree - n] * ofB[n];
        part_[term] += factor * t[degree];
        if (degree <= 2)
        {
          part_[moments + term] += factor * height[degree];
        }
      }
    }
  }

  /// Of all data, to memory that lanes share: the moments of the weights, the first being their sum, and those of the
  /// heights.
  SONO_LANES void sumTo(double* sums) const { wholeSums(part_, sums); }

private:
  double part_[quadraticSums] = {}; ///< a lane's
};

/// The quadratic's first `count` terms, 3 or 6, by its equations' sums; false where the data do not tell them.
SONO_LANES_CALLED inline bool solve(const double* sums, int count, EquationRoom& room, Quadratic& out)
{
  // Products of the terms 1, x, y, x^2, x y, y^2 by the moments.
  static constexpr int product[terms][terms] = { { 0, 1, 2, 3, 4, 5 },    { 1, 3, 4, 6, 7, 8 },
                                                 { 2, 4, 5, 7, 8, 9 },    { 3, 6, 7, 10, 11, 12 },
                                                 { 4, 7, 8, 11, 12, 13 }, { 5, 8, 9, 12, 13, 14 } };
  double* const rows = room.rows;
  const int pitch = count + 2;
  forCells(count, pitch, [&](int r, int c) {
    rows[r * pitch + c] = c < count ? sums[product[r][c]] : c == count ? sums[moments + r] : 1e-9 * sums[product[r][r]];
  });
  if (!eliminate(count, rows))
  {
    return false;
  }
  const auto term = [&](int r) { return r < count ? float(rows[r * pitch + count]) : 0.0f; };
  out = { term(0), term(1), term(2), term(3), term(5), term(4) };
  return true;
}

/// z = q(i, j) + bulge z^2, the branch that is q for no bulge: a plane, a quadratic or a ball.
struct Shape
{
  Quadratic q;
  float bulge = 0.0f;

  SONO_LANES float at(float i, float j) const
  {
    const float k = q.at(i, j);
    return 2.0f * k / (1.0f + std::sqrt(1.0f - 4.0f * bulge * k));
  }

  /// Height, slopes and curvatures in the middle.
  SONO_LANES Quadratic osculating() const
  {
    const float z = at(0.0f, 0.0f);
    const float steepening = 1.0f / (1.0f - 2.0f * bulge * z);
    const float u = q.c1 * steepening;
    const float v = q.c2 * steepening;
    return { z,
             u,
             v,
             (q.c3 + bulge * u * u) * steepening,
             (q.c4 + bulge * v * v) * steepening,
             (q.c5 + 2.0f * bulge * u * v) * steepening };
  }
};

/// Least squares of a ball: z = c0 + c1 x + c2 y + c3 (x^2 + y^2 + z^2), lengths in voxels of the axis of z.
class BallEquations
{
public:
  SONO_LANES BallEquations(double u, double v)
    : u_(u)
    , v_(v)
  {
  }

  /// Columns' sums, row by row, of w, w y, w y^2, w q, w y q, w q^2, w h, w y h, w q h with q = y^2 + h^2: `along` is h
  /// of the z^2, `height` the one to fit.
  class Columns
  {
  public:
    SONO_LANES explicit Columns(double v)
      : v2_(float(v * v))
    {
    }
    SONO_LANES void add(float at, const Floats& along, const Floats& w, const Floats& wh)
    {
      const Floats q = along * along + at * at * v2_;
      const Floats wy = w * at;
      const Floats wq = w * q;
      sum_[0] += w;
      sum_[1] += wy;
      sum_[2] += wy * at;
      sum_[3] += wq;
      sum_[4] += wq * at;
      sum_[5] += wq * q;
      sum_[6] += wh;
      sum_[7] += wh * at;
      sum_[8] += wh * q;
    }
    SONO_LANES const Floats* sums() const { return sum_; }

  private:
    float v2_;
    Floats sum_[9] = {};
  };

  /// Data in columns at these x.
  SONO_LANES void addColumns(const Floats& at, const Columns& columns)
  {
    forNumbers([&](int n) {
      double t[9];
      for (int i = 0; i < 9; ++i)
      {
        t[i] = numberOf(columns.sums()[i], n);
      }
      const double x = u_ * double(numberOf(at, n));
      const double x2 = x * x;
      const double m[ballSums] = { t[0],
                                   x * t[0],
                                   v_ * t[1],
                                   t[3] + x2 * t[0],
                                   t[6],
                                   x2 * t[0],
                                   x * v_ * t[1],
                                   x * (t[3] + x2 * t[0]),
                                   x * t[6],
                                   v_ * v_ * t[2],
                                   v_ * (t[4] + x2 * t[1]),
                                   v_ * t[7],
                                   t[5] + x2 * (2.0 * t[3] + x2 * t[0]),
                                   t[8] + x2 * t[6] };
      for (int i = 0; i < ballSums; ++i)
      {
        part_[i] += m[i];
      }
    });
  }

  SONO_LANES_CALLED bool solve(EquationRoom& room, Shape& out) const
  {
    constexpr int count = 4;
    constexpr int pitch = count + 2;
    // By rows from the diagonal on, the right-hand side last.
    static constexpr int sumOf[count][count + 1] = {
      { 0, 1, 2, 3, 4 }, { 1, 5, 6, 7, 8 }, { 2, 6, 9, 10, 11 }, { 3, 7, 10, 12, 13 }
    };
    wholeSums(part_, room.sums);
    double* const rows = room.rows;
    forCells(count, pitch,
             [&](int r, int c) { rows[r * pitch + c] = c <= count ? room.sums[sumOf[r][c]] : leastPivot; });
    if (!eliminate(count, rows))
    {
      return false;
    }
    const auto term = [&](int r) { return rows[r * pitch + count]; };
    const double bulge = term(3);
    out.q = { float(term(0)),         float(term(1) * u_),    float(term(2) * v_),
              float(bulge * u_ * u_), float(bulge * v_ * v_), 0.0f };
    out.bulge = float(bulge);
    return true;
  }

private:
  static constexpr double leastPivot = 1e-9;

  double u_;
  double v_;
  double part_[ballSums] = {}; ///< a lane's
};

/// How steps at places x of a row, with heights h and weights w, pull at a shape: with stiffness and force. A step is
/// no measurement with noise, it says for certain that the surface lies within half a voxel. So least squares of the
/// distances follow the rounding, which of a plane is a wave as long as a window; the barrier -log(1 - e^2), e the
/// distance over half a voxel, does not. Beyond `wall` it goes on as a parabola, so that a shape may start outside. A
/// ball is linear in its terms by the height of the step in place of its own.
SONO_LANES inline void pull(const Shape& shape, const Floats& x, float y, const Floats& h, const Floats& w,
                            Floats& stiffness, Floats& force)
{
  constexpr float wall = 0.95f;
  const float k0 = shape.q.at(0.0f, y);
  const float k1 = shape.q.c1 + shape.q.c5 * y;
  const float k2 = shape.q.c3;
  const float bulge = shape.bulge;
  Floats perHalf = Floats{} + 2.0f;
  if (bulge != 0.0f)
  {
    const Floats least = Floats{} + 0.1f;
    const Floats room = 0.5f - bulge * h;
    perHalf = 1.0f / (room > least ? room : least);
  }
  const Floats e = (h - (k0 + x * (k1 + x * k2) + bulge * h * h)) * perHalf;
  const Floats far = e < 0.0f ? -e : e;
  const Floats most = Floats{} + wall;
  const Floats within = far < most ? far : most;
  const Floats perRoom = 1.0f / (1.0f - within * within);
  const Floats second = 2.0f * (1.0f + within * within) * perRoom * perRoom;
  const Floats first = 2.0f * within * perRoom + second * (far - within);
  stiffness = w * second * perHalf * perHalf;
  force = w * (e < 0.0f ? -first : first) * perHalf;
}

SONO_LANES inline float smoothStep(float from, float to, float at)
{
  const float x = std::min(1.0f, std::max(0.0f, (at - from) / (to - from)));
  return x * x * (3.0f - 2.0f * x);
}

SONO_LANES inline Quadratic mix(const Quadratic& a, const Quadratic& b, float share)
{
  const auto m = [share](float x, float y) { return x + share * (y - x); };
  return { m(a.c0, b.c0), m(a.c1, b.c1), m(a.c2, b.c2), m(a.c3, b.c3), m(a.c4, b.c4), m(a.c5, b.c5) };
}

SONO_LANES inline void add(Quadratic& sum, const Quadratic& a, float share)
{
  sum = { sum.c0 + share * a.c0, sum.c1 + share * a.c1, sum.c2 + share * a.c2,
          sum.c3 + share * a.c3, sum.c4 + share * a.c4, sum.c5 + share * a.c5 };
}

} // namespace SONO_LANES_NAMESPACE
} // namespace sono::stepfit
