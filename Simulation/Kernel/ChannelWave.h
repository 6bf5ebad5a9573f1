#pragma once

#include "Kernel/FastMath.h"

// What one element of an array sends to a point, and hears of it, at one frequency (Data/docs/physics.md section 15;
// Garcia 2022, "SIMUS: an open-source simulator for medical ultrasound imaging", Comput. Methods Programs Biomed. 218,
// 106726; Cigier, Varray and Garcia 2022, ibid. 220, 106774). An element is cut into pieces along the array, no wider
// than the shortest wavelength:
//
//   G(f) = mean over the pieces of  o(t) sinc(k w sin t / 2) exp(i k r) / r  x  E(y, r)                       (15.1)
//
// with r from the piece's middle to the point, t the angle from its normal in the image plane, w its width, o = cos t
// in a soft baffle and 1 in a rigid one, sinc x = sin(x)/x. E is the mean over the element's height h with its lens F,
// in Fresnel's approximation, the height's window being a sum of Gaussians A exp(-B (y/h)^2):
//
//   E(y, r) = 1/h  sum of A sqrt(pi / q) exp(-(k y / r)^2 / (4 q)),   q = B/h^2 + (i k / 2) (1/F - 1/r)       (15.2)
//
// A flat one, of endless height, has 1/sqrt(r) in place of 1/r and no E.

namespace sono {

struct ComplexNumber
{
  float re;
  float im;
};

SONO_HD inline ComplexNumber operator*(const ComplexNumber& a, const ComplexNumber& b)
{
  return { a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re };
}

/// exp(2 pi i turns), absolute error below 3e-7 and that of the turns.
SONO_HD inline ComplexNumber turned(float turns)
{
  const float rest = turns - floorf(turns + 0.5f);         // [-1/2, 1/2]
  const float quarter = floorf(4.0f * fabsf(rest) + 0.5f); // 0, 1 or 2
  const float angle = 6.2831853f * (fabsf(rest) - 0.25f * quarter);
  const float c = cosSmall(angle);
  const float s = sinSmall(angle);
  const float cosine = quarter == 0.0f ? c : (quarter == 1.0f ? -s : -c);
  const float sine = quarter == 0.0f ? s : (quarter == 1.0f ? c : -s);
  return { cosine, rest < 0.0f ? -sine : sine };
}

/// sin(x)/x from x^2, |x| <= pi: absolute error below 2e-7 (Taylor to x^16).
SONO_HD inline float sincOfSquare(float q)
{
  float s = 2.81145725e-15f;
  s = s * q - 7.64716373e-13f;
  s = s * q + 1.60590438e-10f;
  s = s * q - 2.50521084e-8f;
  s = s * q + 2.75573192e-6f;
  s = s * q - 1.98412698e-4f;
  s = s * q + 8.33333333e-3f;
  s = s * q - 1.66666667e-1f;
  return s * q + 1.0f;
}

/// The principal root.
SONO_HD inline ComplexNumber rootOf(const ComplexNumber& a)
{
  const float modulus = sqrtf(a.re * a.re + a.im * a.im);
  const float re = sqrtf(larger(0.0f, 0.5f * (modulus + a.re)));
  const float im = sqrtf(larger(0.0f, 0.5f * (modulus - a.re)));
  return { re, a.im < 0.0f ? -im : im };
}

/// Of an array's elements what is the same for all.
struct ElementShape
{
  float perHeightMm = 0.0f; ///< 1/h; 0: flat
  float perFocusMm = 0.0f;  ///< 1/F; 0: no lens
  float wavesPerMm = 0.0f;  ///< 1/c: wave numbers k / (2 pi) are this times the frequency, us/mm
};

/// E of (15.2); `waves` is k / (2 pi), `perR` 1/r.
SONO_HD inline ComplexNumber elevationMean(const ElementShape& shape, float waves, float yMm, float perR)
{
  const float k = 6.2831853f * waves;
  const float h2 = shape.perHeightMm * shape.perHeightMm;
  const float alpha = 0.5f * k * (shape.perFocusMm - perR);
  const float across = k * yMm * perR;
  ComplexNumber sum{ 0.0f, 0.0f };
  for (int n = 0; n < 4; ++n)
  {
    // Two Gaussians and their conjugates (Wen and Breazeale 1988; SIMUS's numbers).
    const bool isFirst = (n & 1) == 0;
    const float sign = n < 2 ? 1.0f : -1.0f;
    const ComplexNumber a{ isFirst ? 0.187f : 0.288f, sign * (isFirst ? 0.275f : -1.954f) };
    const ComplexNumber q{ (isFirst ? 4.558f : 8.598f) * h2, sign * (isFirst ? -25.59f : -7.924f) * h2 + alpha };
    const float perNorm = 1.0f / (q.re * q.re + q.im * q.im);
    const ComplexNumber perQ{ q.re * perNorm, -q.im * perNorm };
    const float power = -0.25f * across * across;
    const ComplexNumber turn = turned(power * perQ.im * 0.15915494f);
    const float size = expNegative(power * perQ.re) * 1.7724539f * shape.perHeightMm;
    const ComplexNumber part = a * rootOf(perQ) * turn;
    sum.re += size * part.re;
    sum.im += size * part.im;
  }
  return sum;
}

/// A curve of the fourth degree over [-1, 1].
struct ComplexCurve
{
  static constexpr int nodes = 5; ///< at -1, -1/2, 0, 1/2, 1

  ComplexNumber c[nodes]; ///< by power

  SONO_HD static float place(int node) { return 0.5f * float(node - 2); }
  SONO_HD ComplexNumber at(float x) const
  {
    ComplexNumber sum = c[4];
    for (int n = 3; n >= 0; --n)
    {
      sum = { c[n].re + x * sum.re, c[n].im + x * sum.im };
    }
    return sum;
  }
};

/// The powers' factors of one part of a curve from its values at the nodes, in place.
SONO_HD inline void curveThrough(float* v)
{
  const float middle = v[2];
  const float odd = 0.5f * (v[4] - v[0]);
  const float third = 1.3333333f * (odd - (v[3] - v[1]));
  const float even = 0.5f * (v[4] + v[0]) - middle;
  const float fourth = 1.3333333f * (even - 2.0f * (v[3] + v[1]) + 4.0f * middle);
  v[0] = middle;
  v[1] = odd - third;
  v[2] = even - fourth;
  v[3] = third;
  v[4] = fourth;
}

/// The span of 1/r over an array's elements, over which E is a ComplexCurve: within 0.4 % (20 mm before a P4-2), mostly
/// 0.1 %.
struct InverseRange
{
  float middle;
  float half; ///< > 0

  SONO_HD float at(float perR) const { return (perR - middle) / half; }
};

/// E at a frequency, for all elements.
SONO_HD inline ComplexCurve elevationCurve(const ElementShape& shape, float waves, float yMm, const InverseRange& span)
{
  float re[ComplexCurve::nodes];
  float im[ComplexCurve::nodes];
  for (int n = 0; n < ComplexCurve::nodes; ++n)
  {
    const ComplexNumber e = elevationMean(shape, waves, yMm, span.middle + ComplexCurve::place(n) * span.half);
    re[n] = e.re;
    im[n] = e.im;
  }
  curveThrough(re);
  curveThrough(im);
  ComplexCurve curve;
  for (int n = 0; n < ComplexCurve::nodes; ++n)
  {
    curve.c[n] = { re[n], im[n] };
  }
  return curve;
}

/// A piece of an element in the image plane.
struct ElementPiece
{
  float x, z;
  float normalX, normalZ; ///< unit
};

/// How a piece sees a point: its distance, the square of half its width across the ray, and the size of its wave
/// without directivity.
struct PieceSight
{
  float rangeMm;
  float halfAcross2; ///< (w sin t / 2)^2, mm^2
  float size;
};

/// `shortestMm` is half a wavelength: nearer points count as if so far away. Behind the piece the size is 0.
SONO_HD inline PieceSight pieceSees(const ElementPiece& piece, float halfWidthMm, bool isSoft, bool isFlat,
                                    float shortestMm, float x, float y, float z)
{
  const float dx = x - piece.x;
  const float dz = z - piece.z;
  const float plane2 = dx * dx + dz * dz;
  const float perPlane = 1.0f / sqrtf(larger(plane2, 1e-12f));
  const float cosine = (dx * piece.normalX + dz * piece.normalZ) * perPlane;
  const float across = halfWidthMm * (dx * piece.normalZ - dz * piece.normalX) * perPlane;
  const float range = larger(shortestMm, sqrtf(isFlat ? plane2 : plane2 + y * y));
  const float spread = isFlat ? 1.0f / sqrtf(range) : 1.0f / range;
  return { range, across * across, cosine > 0.0f ? (isSoft ? cosine : 1.0f) * spread : 0.0f };
}

} // namespace sono
