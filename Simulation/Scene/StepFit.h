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
      const double m[15] = { y[0],           x1 * y[0],      y[1],      x2 * y[0], x1 * y[1],
                             y[2],           x2 * x1 * y[0], x2 * y[1], x1 * y[2], y[3],
                             x2 * x2 * y[0], x2 * x1 * y[1], x2 * y[2], x1 * y[3], y[4] };
      for (int i = 0; i < 15; ++i)
      {
        moment_[i] += m[i];
      }
      const double r[terms] = { height[0], x1 * height[0], height[1], x2 * height[0], x1 * height[1], height[2] };
      for (int i = 0; i < terms; ++i)
      {
        right_[i] += r[i];
      }
    });
  }

  /// Of all data.
  SONO_LANES double weight() const { return wholeSum(moment_[0]); }

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
        moment_[term] += factor * t[degree];
        if (degree <= 2)
        {
          right_[term] += factor * height[degree];
        }
      }
    }
  }

  /// In the first `count` terms, 3 or 6; false where the data do not tell them.
  SONO_LANES_CALLED bool solve(int count, Quadratic& out) const
  {
    // Products of the terms 1, x, y, x^2, x y, y^2 by the moments above.
    static constexpr int product[terms][terms] = { { 0, 1, 2, 3, 4, 5 },    { 1, 3, 4, 6, 7, 8 },
                                                   { 2, 4, 5, 7, 8, 9 },    { 3, 6, 7, 10, 11, 12 },
                                                   { 4, 7, 8, 11, 12, 13 }, { 5, 8, 9, 12, 13, 14 } };
    double a[terms][terms];
    double b[terms];
    double moment[15];
    SONO_ROLLED
    for (int i = 0; i < 15; ++i)
    {
      moment[i] = wholeSum(moment_[i]);
    }
    SONO_ROLLED
    for (int r = 0; r < count; ++r)
    {
      SONO_ROLLED
      for (int c = 0; c < count; ++c)
      {
        a[r][c] = moment[product[r][c]];
      }
      b[r] = wholeSum(right_[r]);
    }
    // Positive definite: no pivoting.
    SONO_ROLLED
    for (int r = 0; r < count; ++r)
    {
      if (!(a[r][r] > 1e-9 * moment[product[r][r]]))
      {
        return false;
      }
      SONO_ROLLED
      for (int q = r + 1; q < count; ++q)
      {
        const double m = a[q][r] / a[r][r];
        SONO_ROLLED
        for (int c = r; c < count; ++c)
        {
          a[q][c] -= m * a[r][c];
        }
        b[q] -= m * b[r];
      }
    }
    SONO_ROLLED
    for (int r = count - 1; r >= 0; --r)
    {
      SONO_ROLLED
      for (int c = r + 1; c < count; ++c)
      {
        b[r] -= a[r][c] * b[c];
      }
      b[r] /= a[r][r];
    }
    out = { float(b[0]), float(b[1]), float(b[2]), 0.0f, 0.0f, 0.0f };
    if (count == terms)
    {
      out.c3 = float(b[3]);
      out.c5 = float(b[4]);
      out.c4 = float(b[5]);
    }
    return true;
  }

private:
  double moment_[15] = {};
  double right_[terms] = {};
};

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
      a_[0][0] += t[0];
      a_[0][1] += x * t[0];
      a_[0][2] += v_ * t[1];
      a_[0][3] += t[3] + x2 * t[0];
      a_[0][4] += t[6];
      a_[1][1] += x2 * t[0];
      a_[1][2] += x * v_ * t[1];
      a_[1][3] += x * (t[3] + x2 * t[0]);
      a_[1][4] += x * t[6];
      a_[2][2] += v_ * v_ * t[2];
      a_[2][3] += v_ * (t[4] + x2 * t[1]);
      a_[2][4] += v_ * t[7];
      a_[3][3] += t[5] + x2 * (2.0 * t[3] + x2 * t[0]);
      a_[3][4] += t[8] + x2 * t[6];
    });
  }

  SONO_LANES_CALLED bool solve(Shape& out)
  {
    double a[4][5];
    SONO_ROLLED
    for (int r = 0; r < 4; ++r)
    {
      SONO_ROLLED
      for (int c = r; c < 5; ++c)
      {
        a[r][c] = wholeSum(a_[r][c]);
      }
    }
    SONO_ROLLED
    for (int r = 0; r < 4; ++r)
    {
      if (!(a[r][r] > 1e-9))
      {
        return false;
      }
      SONO_ROLLED
      for (int q = r + 1; q < 4; ++q)
      {
        const double m = a[r][q] / a[r][r];
        SONO_ROLLED
        for (int c = q; c < 5; ++c)
        {
          a[q][c] -= m * a[r][c];
        }
      }
    }
    double b[4];
    SONO_ROLLED
    for (int r = 3; r >= 0; --r)
    {
      b[r] = a[r][4];
      SONO_ROLLED
      for (int c = r + 1; c < 4; ++c)
      {
        b[r] -= a[r][c] * b[c];
      }
      b[r] /= a[r][r];
    }
    out.q = { float(b[0]), float(b[1] * u_), float(b[2] * v_), float(b[3] * u_ * u_), float(b[3] * v_ * v_), 0.0f };
    out.bulge = float(b[3]);
    return true;
  }

private:
  double u_;
  double v_;
  double a_[4][5] = {};
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
  const Floats least = Floats{} + 0.1f;
  const Floats room = 0.5f - bulge * h;
  const Floats perHalf = 1.0f / (room > least ? room : least);
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
