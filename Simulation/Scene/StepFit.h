#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

// Least-squares fits of planes, balls and quadratics to a staircase's heights, voxels (SurfacePieces).

namespace sono::stepfit {

/// Sums of weight x^n, and of weight height x^n.
struct RowSums
{
  double x[5] = {};
  double height[3] = {};

  void add(double at, double h, double weight)
  {
    const double w1 = weight * at;
    const double w2 = w1 * at;
    x[0] += weight;
    x[1] += w1;
    x[2] += w2;
    x[3] += w2 * at;
    x[4] += w2 * at * at;
    height[0] += weight * h;
    height[1] += w1 * h;
    height[2] += w2 * h;
  }
};

/// Weights of a window's columns, (2 R + 1)^2: round, and smooth to the rim so that a terrace's harmonics are not let
/// through.
struct Window
{
  std::vector<float> weight;
  std::vector<float> strictness; ///< what of a column's excess counts

  std::vector<RowSums> rows; ///< of columns of height 0

  explicit Window(int radius)
    : rows(std::size_t(2 * radius + 1))
  {
    for (int j = -radius; j <= radius; ++j)
    {
      for (int i = -radius; i <= radius; ++i)
      {
        const double q = std::max(0.0, 1.0 - double(i * i + j * j) / ((radius + 1.0) * (radius + 1.0)));
        weight.push_back(float(q * q * q * q));
        rows[std::size_t(j + radius)].add(i, 0.0, weight.back());
        strictness.push_back(float(std::min(1.0, 2.0 * q * q)));
      }
    }
  }
};

/// c0 + c1 i + c2 j + c3 i^2 + c4 j^2 + c5 i j, voxels.
struct Quadratic
{
  float c0, c1, c2, c3, c4, c5;
  float at(float i, float j) const { return c0 + c1 * i + c2 * j + c3 * i * i + c4 * j * j + c5 * i * j; }
};

constexpr int terms = 6;

/// Normal equations of a quadratic's weighted least squares.
class NormalEquations
{
public:
  /// A row of data at this y: sums of weight x^n, n = 0 to 4, and of weight height x^n, n = 0 to 2.
  void addRow(double y, const double* x, const double* height)
  {
    const double y2 = y * y;
    const double m[15] = { x[0],      x[1],     y * x[0],  x[2],          y * x[1],
                           y2 * x[0], x[3],     y * x[2],  y2 * x[1],     y2 * y * x[0],
                           x[4],      y * x[3], y2 * x[2], y2 * y * x[1], y2 * y2 * x[0] };
    for (int i = 0; i < 15; ++i)
    {
      moment_[i] += m[i];
    }
    const double r[terms] = { height[0], height[1], y * height[0], height[2], y * height[1], y2 * height[0] };
    for (int i = 0; i < terms; ++i)
    {
      right_[i] += r[i];
    }
  }

  /// In the first `count` terms, 3 or 6; false where the data do not tell them.
  bool solve(int count, Quadratic& out) const
  {
    // Products of the terms 1, x, y, x^2, x y, y^2 by the moments above.
    static constexpr int product[terms][terms] = { { 0, 1, 2, 3, 4, 5 },    { 1, 3, 4, 6, 7, 8 },
                                                   { 2, 4, 5, 7, 8, 9 },    { 3, 6, 7, 10, 11, 12 },
                                                   { 4, 7, 8, 11, 12, 13 }, { 5, 8, 9, 12, 13, 14 } };
    double a[terms][terms];
    double b[terms];
    for (int r = 0; r < count; ++r)
    {
      for (int c = 0; c < count; ++c)
      {
        a[r][c] = moment_[product[r][c]];
      }
      b[r] = right_[r];
    }
    // Positive definite: no pivoting.
    for (int r = 0; r < count; ++r)
    {
      if (!(a[r][r] > 1e-9 * moment_[product[r][r]]))
      {
        return false;
      }
      for (int q = r + 1; q < count; ++q)
      {
        const double m = a[q][r] / a[r][r];
        for (int c = r; c < count; ++c)
        {
          a[q][c] -= m * a[r][c];
        }
        b[q] -= m * b[r];
      }
    }
    for (int r = count - 1; r >= 0; --r)
    {
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

  float at(float i, float j) const
  {
    const float k = q.at(i, j);
    return 2.0f * k / (1.0f + std::sqrt(1.0f - 4.0f * bulge * k));
  }

  /// Height, slopes and curvatures in the middle.
  Quadratic osculating() const
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
  BallEquations(double u, double v)
    : u_(u)
    , v_(v)
  {
  }

  /// Data at one y: `count` places x from `first` on, a step of 1 apart, their heights and weights. The arrays go on to
  /// a multiple of four with weights of 0.
  void addRow(double first, double y, int count, const float* height, const float* weight)
  {
    Doubles s[9] = {}; // sums of w, w x, w x^2, w q, w x q, w q^2, w h, w x h, w q h with q = x^2 + h^2
    Doubles x = Doubles{ 0.0, 1.0, 2.0, 3.0 } + first;
    for (int n = 0; n < count; n += 4, x += 4.0)
    {
      const Doubles h = { height[n], height[n + 1], height[n + 2], height[n + 3] };
      const Doubles w = { weight[n], weight[n + 1], weight[n + 2], weight[n + 3] };
      const Doubles q = x * x * (u_ * u_) + h * h;
      const Doubles wx = w * x;
      const Doubles wq = w * q;
      s[0] += w;
      s[1] += wx;
      s[2] += wx * x;
      s[3] += wq;
      s[4] += wx * q;
      s[5] += wq * q;
      s[6] += w * h;
      s[7] += wx * h;
      s[8] += wq * h;
    }
    double t[9];
    for (int i = 0; i < 9; ++i)
    {
      t[i] = (s[i][0] + s[i][1]) + (s[i][2] + s[i][3]);
    }
    addSums(t, y * v_);
  }

  void add(double x, double y, double h, double w)
  {
    const double q = x * x * u_ * u_ + h * h;
    const double t[9] = { w, w * x, w * x * x, w * q, w * x * q, w * q * q, w * h, w * x * h, w * q * h };
    addSums(t, y * v_);
  }

  bool solve(Shape& out)
  {
    double(&a)[4][5] = a_;
    for (int r = 0; r < 4; ++r)
    {
      if (!(a[r][r] > 1e-9))
      {
        return false;
      }
      for (int q = r + 1; q < 4; ++q)
      {
        const double m = a[r][q] / a[r][r];
        for (int c = q; c < 5; ++c)
        {
          a[q][c] -= m * a[r][c];
        }
      }
    }
    double b[4];
    for (int r = 3; r >= 0; --r)
    {
      b[r] = a[r][4];
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
  using Doubles = double __attribute__((vector_size(32)));

  /// Of one y; x in columns.
  void addSums(const double* t, double y)
  {
    const double y2 = y * y;
    a_[0][0] += t[0];
    a_[0][1] += u_ * t[1];
    a_[0][2] += y * t[0];
    a_[0][3] += t[3] + y2 * t[0];
    a_[0][4] += t[6];
    a_[1][1] += u_ * u_ * t[2];
    a_[1][2] += u_ * y * t[1];
    a_[1][3] += u_ * (t[4] + y2 * t[1]);
    a_[1][4] += u_ * t[7];
    a_[2][2] += y2 * t[0];
    a_[2][3] += y * (t[3] + y2 * t[0]);
    a_[2][4] += y * t[6];
    a_[3][3] += t[5] + y2 * (2.0 * t[3] + y2 * t[0]);
    a_[3][4] += t[8] + y2 * t[6];
  }

  double u_;
  double v_;
  double a_[4][5] = {};
};

inline float smoothStep(float from, float to, float at)
{
  const float x = std::min(1.0f, std::max(0.0f, (at - from) / (to - from)));
  return x * x * (3.0f - 2.0f * x);
}

inline Quadratic mix(const Quadratic& a, const Quadratic& b, float share)
{
  const auto m = [share](float x, float y) { return x + share * (y - x); };
  return { m(a.c0, b.c0), m(a.c1, b.c1), m(a.c2, b.c2), m(a.c3, b.c3), m(a.c4, b.c4), m(a.c5, b.c5) };
}

} // namespace sono::stepfit
