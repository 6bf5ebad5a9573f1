#pragma once

#include "Kernel/Lobe.h"
#include "Kernel/Rng.h"
#include "Kernel/Vec.h"

#include <cmath>

namespace sono {

/// What happens at a boundary: fluid acoustics at a rough surface (RoughSurface.h), or the equations of Amadou et al.
/// 2024 to the letter, lobe included. The latter do not conserve energy: the branch's R or T is applied although the
/// choice carries it already, and cos(theta)/p(omega) averages to pi over the hemisphere. Data/docs/physics.md
/// section 1.
enum class InterfaceModel
{
  Acoustic,
  Amadou2024
};

/// Reflection at a boundary for an incident angle.
struct Reflection
{
  float reflectance;  ///< R = r^2 in [0, 1]
  float cosRefracted; ///< cos(theta2); 0 at total reflection
  float ratio;        ///< sin(theta2) / sin(theta1)
  bool total;         ///< no real refracted angle: R = 1
  float amplitude;    ///< r, with its sign
};

/// R for a plane wave from medium 1 onto medium 2. Acoustic: Snell with sound speeds and
/// r = (Z2 cos1 - Z1 cos2)/(Z2 cos1 + Z1 cos2), the fluid-fluid formula. Amadou2024: eq. 1 to 4, where
/// impedances take the place of Snell's speeds and the angles are exchanged in r.
SONO_HD inline Reflection reflectionAt(InterfaceModel model, float z1, float z2, float c1, float c2, float cos1)
{
  const float ratio = model == InterfaceModel::Acoustic ? c2 / c1 : z1 / z2;
  const float sinSquared = ratio * ratio * fmaxf(0.0f, 1.0f - cos1 * cos1);
  if (sinSquared >= 1.0f)
  {
    return { 1.0f, 0.0f, ratio, true, 1.0f };
  }
  const float cos2 = sqrtf(1.0f - sinSquared);
  const float a = model == InterfaceModel::Acoustic ? z2 * cos1 : z2 * cos2;
  const float b = model == InterfaceModel::Acoustic ? z1 * cos2 : z1 * cos1;
  const float r = (a - b) / (a + b);
  return { r * r, cos2, ratio, false, r };
}

/// The branch that a path takes.
struct Scattered
{
  Vec3f direction;
  bool reflected;
  float throughput;    ///< factor of the intensity
  float amplitude;     ///< factor of the amplitude of what is in phase, with its sign; 0: nothing is
  float choice = 0.0f; ///< where in the branch's share the number that chose it lies, where the way is a coherent one
};

/// Mirror direction; `normal` points from medium 1 into medium 2, cos1 = direction . normal > 0.
SONO_HD inline Vec3f mirrorDirection(const Vec3f& direction, const Vec3f& normal, float cos1)
{
  return direction - normal * (2.0f * cos1);
}

/// Refracted direction: the tangential part is scaled by sin2/sin1.
SONO_HD inline Vec3f refractedDirection(const Vec3f& direction, const Vec3f& normal, float cos1, const Reflection& r)
{
  return (direction - normal * cos1) * r.ratio + normal * r.cosRefracted;
}

/// Centre of a branch's lobe.
SONO_HD inline Vec3f branchDirection(const Vec3f& direction, const Vec3f& normal, float cos1, const Reflection& r,
                                     bool reflected)
{
  return glm::normalize(reflected ? mirrorDirection(direction, normal, cos1)
                                  : refractedDirection(direction, normal, cos1, r));
}

/// Amadou2024's choice: draws the branch and its direction from the lobe around the mirror or refracted direction, and
/// weights both. A direction on the wrong side of the surface is mirrored across the tangent plane
/// (Data/docs/physics.md section 2).
SONO_HD inline Scattered scatterByLobe(const Lobe& lobe, const Vec3f& direction, const Vec3f& normal, float cos1,
                                       const Reflection& r, const BounceSample& u)
{
  Scattered out{};
  out.reflected = u.choice < r.reflectance || r.total;
  const Vec3f centre = branchDirection(direction, normal, cos1, r, out.reflected);
  const float phi = samplePolar(lobe, u.polar);
  Vec3f w = phi > 0.0f ? directionAround(centre, phi, u.azimuth) : centre;
  const float side = glm::dot(w, normal);
  if (out.reflected ? side > 0.0f : side < 0.0f)
  {
    w -= normal * (2.0f * side);
  }
  out.direction = w;
  const float branch = out.reflected ? r.reflectance : 1.0f - r.reflectance;
  const float psi = polarDensity(lobe, phi);
  // cos / p with p = psi / (2 pi sin phi); a mirror has no density: the weight is the cosine alone.
  const float cosOut = fabsf(glm::dot(w, normal));
  out.throughput = branch * cosOut * (psi > 0.0f ? 6.28318531f * sinf(phi) / psi : 1.0f);
  return out;
}

/// Amplitude of the echo that a boundary returns along the beam, for unit intensity weight w_R left to the caller.
SONO_HD inline float boundaryEcho(InterfaceModel model, float z1, float z2, float intensity, float cos1, float tau,
                                  float gamma)
{
  const float r0 = fabsf(z2 - z1) / (z2 + z1);
  float shaped = tau == 1.0f ? intensity : powf(intensity, tau);
  if (gamma != 0.0f)
  {
    // A grazing hit with gamma < 0 would diverge; a thousandth is 0.06 degrees from grazing.
    shaped *= powf(fmaxf(cos1, 1e-3f), gamma);
  }
  return (model == InterfaceModel::Acoustic ? r0 : r0 * r0) * shaped;
}

} // namespace sono
