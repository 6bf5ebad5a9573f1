#pragma once

#include "Kernel/FastMath.h"
#include "Kernel/Interface.h"
#include "Kernel/NormalDeviate.h"
#include "Kernel/Rng.h"
#include "Kernel/Vec.h"

#include <cmath>

// A rough boundary (Data/docs/physics.md section 10): a share of each branch goes on coherently, exactly along the
// mirrored or refracted direction; the rest is scattered by facets whose slopes are Beckmann's. The facets' share is
// followed on the microsurface until it leaves it (Heitz, Hanika, d'Eon and Dachsbacher 2016, "Multiple-scattering
// microfacet BSDFs with the Smith model"), which keeps its energy and is reciprocal.

namespace sono {

/// What parts two media, seen from the first.
struct RoughBoundary
{
  float heightMm = 0.0f;    ///< rms
  float alpha = 0.0f;       ///< Beckmann's width, 2 h / l (10.2), up to steepestAlpha
  float waveNumber1 = 0.0f; ///< k = 2 pi f / c in front, rad/mm
  float waveNumber2 = 0.0f; ///< behind
};

/// A height field steeper than that has no meaning, and paths would rattle about in it.
constexpr float steepestAlpha = 2.0f;

/// Facets that a path may meet in one surface. What is still inside then leaves on the side where it is: none of a
/// million paths at the steepest, from above as aslant.
constexpr int mostFacets = 64;

/// C_R, C_T (10.3): the share of a branch's power that goes on exactly along its direction.
SONO_HD inline float coherentShare(const RoughBoundary& rough, float cos1, float cos2, bool reflected)
{
  const float phase = rough.heightMm * (reflected ? 2.0f * rough.waveNumber1 * cos1
                                                  : rough.waveNumber1 * cos1 - rough.waveNumber2 * cos2);
  return expNegative(-phase * phase);
}

/// Smith's Lambda for Beckmann's slopes and a direction that makes the cosine |z| with the mean normal: a masked ray
/// meets facets at this rate. Beyond four widths it is below 1e-9.
SONO_HD inline float smithLambda(float alpha, const Vec3f& direction)
{
  const float sine = quickSqrt(direction.x * direction.x + direction.y * direction.y);
  const float cosine = fabsf(direction.z);
  if (cosine > 4.0f * alpha * sine)
  {
    return 0.0f;
  }
  const float a = larger(cosine / (alpha * sine), 1e-4f);
  return larger(0.0f, 0.5f * (0.564189584f * expNegative(-a * a) / a - erfcf(a)));
}

/// A slope along the incident direction, in widths, as it is seen from there: density (a - s) exp(-s^2), s < a, with a
/// the cotangent of the incidence on the surface stretched to unit width (Heitz and d'Eon 2014). Halley's method on
/// the distribution function, kept within a bracket; most take an erfc or two.
SONO_HD inline float visibleSlope(float a, float u)
{
  constexpr float perRootPi = 0.564189584f;
  const float unseen = -0.707106781f * normalFromUpperTail(u); // of this slope, seen or not, a share u lies below
  float s = smaller(unseen, a);
  if (a > 1e3f)
  {
    return s; // seen from straight above: all of them
  }
  const float most = 0.5f * a * (a > 4.0f ? 2.0f : erfcf(-a)) + 0.5f * perRootPi * expNegative(-a * a);
  const float target = u * most;
  const float close = 1e-6f * most;
  float low = -6.0f;
  float high = larger(a, low);
  s = larger(s, low);
  for (int i = 0; i < 20; ++i)
  {
    const float density = perRootPi * expNegative(-s * s);
    const float below = s == unseen ? u : 0.5f * erfcf(-s);
    const float excess = a * below + 0.5f * density - target;
    if (fabsf(excess) < close)
    {
      break;
    }
    (excess > 0.0f ? high : low) = s;
    const float step = excess / larger((a - s) * density, 1e-30f);
    const float bend = 1.0f + step * (s + 0.5f / larger(a - s, 1e-6f));
    const float next = s - step / larger(bend, 0.5f);
    const bool isInside = next > low && next < high;
    s = isInside ? next : 0.5f * (low + high);
    if (isInside && fabsf(step) < 3e-3f && bend > 0.9f)
    {
      break; // the next step is of its third power
    }
  }
  return s;
}

/// Normal of a facet as it is seen along `towards`, a unit vector from the surface; the mean normal is z.
SONO_HD inline Vec3f visibleNormal(float alpha, const Vec3f& towards, float u, float v)
{
  const float sine = quickSqrt(towards.x * towards.x + towards.y * towards.y);
  const float a = towards.z / larger(alpha * sine, 1e-6f);
  const float along = visibleSlope(a, u);
  const float across = 0.707106781f * normalDeviate(v);
  const bool oblique = sine > 1e-6f;
  const float x = oblique ? towards.x / sine : 1.0f;
  const float y = oblique ? towards.y / sine : 0.0f;
  return glm::normalize(Vec3f(-alpha * (x * along - y * across), -alpha * (y * along + x * across), 1.0f));
}

/// Where a path has got to on a microsurface.
struct FacetPath
{
  Vec3f direction; ///< of travel; z points from the surface into the side on which the path is
  bool behind;     ///< on the far side
};

/// Follows a path from above onto the facets and on until it leaves them. Facets mirror, or all refract where they can:
/// `ratio` is c2 / c1, or 0 for mirrors. The facets' heights are uniform: only their order counts. `u` chooses the
/// first facet, and what else is drawn is a function of it.
SONO_HD inline FacetPath walkFacets(float alpha, const Vec3f& incident, float ratio, const BounceSample& u)
{
  FacetPath path{ incident, false };
  Vec3f& w = path.direction;
  float below = 1.0f; // share of the surface that lies lower than the path
  const auto key = [](float seen) { return std::uint64_t(std::uint32_t(seen * 8388608.0f)); };
  const std::uint64_t facets = (key(u.polar) << 32) | key(u.azimuth);
  for (int facet = 0; facet <= mostFacets; ++facet)
  {
    const float lambda = smithLambda(alpha, w);
    if (w.z > 0.0f && lambda == 0.0f)
    {
      break;
    }
    const RandomWords words = philox(facets, 0u, std::uint32_t(facet), 0x51ab7e5u, 0u);
    const float chance = uniformFrom(words.v[0]);
    if (w.z > 0.0f)
    {
      if (chance < powf(below, lambda))
      {
        break;
      }
      below = smaller(1.0f, below * powf(chance, -1.0f / lambda));
    }
    else
    {
      below *= powf(chance, 1.0f / (1.0f + lambda));
    }
    if (facet == mostFacets)
    {
      w.z = fabsf(w.z);
      break;
    }
    const Vec3f m = facet == 0 ? visibleNormal(alpha, -w, u.polar, u.azimuth)
                               : visibleNormal(alpha, -w, uniformFrom(words.v[1]), uniformFrom(words.v[2]));
    const float cosine = larger(0.0f, -glm::dot(w, m));
    const float bend = path.behind && ratio > 0.0f ? 1.0f / ratio : ratio;
    const float sineSquared = bend * bend * larger(0.0f, 1.0f - cosine * cosine);
    if (ratio > 0.0f && sineSquared < 1.0f)
    {
      w = (w + m * cosine) * bend - m * sqrtf(1.0f - sineSquared);
      // Seen from the other side.
      w.z = -w.z;
      path.behind = !path.behind;
      below = larger(1.0f - below, 1e-7f);
    }
    else
    {
      w += m * (2.0f * cosine);
    }
    w = glm::normalize(w);
  }
  return path;
}

/// The chance with which a path is reflected. Reverberation is heard by its amplitude, so weak boundaries reflect more
/// paths than their R, each of which counts less: a quarter of |r|, so that what a path stands for is at most four
/// times what there is; and |r| for a path between mirrors, which has been reflected and is still in phase, for the
/// multiples that only such paths tell.
SONO_HD inline float reflectionChance(const Reflection& r, bool favoursReflections, bool betweenMirrors)
{
  if (r.total)
  {
    return 1.0f;
  }
  return favoursReflections ? larger(r.reflectance, (betweenMirrors ? 1.0f : 0.25f) * fabsf(r.amplitude)) : 0.0f;
}

/// Where in a share of all numbers one lies, [0, 1] but for rounding.
SONO_HD inline float choiceWithin(float choice, float from, float share)
{
  return (choice - from) / larger(share, 1e-30f);
}

/// Draws the branch with a chance (see reflectionChance), then whether it goes on coherently, else the facets that it
/// meets. One number decides on both: with p its strata are p C_R, p (1 - C_R), (1 - p) C_T and (1 - p) (1 - C_T).
/// `normal` points from medium 1 into medium 2, cos1 = direction . normal > 0. The throughput is the mean surface's R
/// or T over the chance.
SONO_HD inline Scattered scatterRough(const RoughBoundary& rough, const Vec3f& direction, const Vec3f& normal,
                                      float cos1, const Reflection& r, float chance, const BounceSample& u)
{
  const bool reflected = r.total || u.choice < chance;
  const float before = reflected ? 0.0f : chance;
  const float drawn = reflected ? chance : 1.0f - chance;
  const float share = reflected ? r.reflectance : 1.0f - r.reflectance;
  const float throughput = drawn > 0.0f ? share / drawn : 0.0f;
  const float coherent = rough.alpha <= 0.0f ? 1.0f : coherentShare(rough, cos1, r.cosRefracted, reflected);
  if (rough.alpha <= 0.0f || u.choice <= before + drawn * coherent)
  {
    // Of what is in phase, sqrt(C), the share C of the paths tells.
    const float amplitude = drawn > 0.0f && coherent > 0.0f ? sqrtf(share / coherent) / drawn : 0.0f;
    return { branchDirection(direction, normal, cos1, r, reflected), reflected, throughput,
             reflected && r.amplitude < 0.0f ? -amplitude : amplitude,
             choiceWithin(u.choice, before, drawn * coherent) };
  }
  // A frame whose z points back to where the path comes from, x along its slant.
  const Vec3f slant = direction - normal * cos1;
  const float sine = glm::length(slant);
  const Vec3f x = sine > 1e-4f ? slant / sine : directionAround(normal, 1.57079633f, 0.25f);
  const Vec3f y = glm::cross(x, normal);
  const Vec3f incident(glm::dot(direction, x), glm::dot(direction, y), -larger(cos1, 1e-6f));
  const FacetPath out = walkFacets(rough.alpha, incident, reflected ? 0.0f : r.ratio, u);
  const float along = larger(out.direction.z, 1e-6f);
  const Vec3f w = x * out.direction.x + y * out.direction.y + normal * (out.behind ? along : -along);
  return { glm::normalize(w), !out.behind, throughput, 0.0f };
}

} // namespace sono
