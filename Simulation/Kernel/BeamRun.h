#pragma once

#include "Kernel/SurfaceEcho.h"

namespace sono {

/// Lines that follow each other, of one kind and one aperture, so that most faces of boundaries can be ruled out for
/// all of them at once. A place's coordinates in the frame of any of the beams differ from those in the middle one's by
/// at most `apart` + `turn` times its distance from the origins.
struct BeamRun
{
  Beam middle; ///< as wide as the widest
  int first;
  int count;
  float originsMm; ///< how far origins are from the middle's
  Vec3f apartMm;   ///< the same, along the middle's axis, lateral and elevation
  Vec3f turn;      ///< how far those unit vectors are from the middle's
};

/// Of beams[first] to beams[first + count - 1], at least one.
SONO_HD inline BeamRun beamRun(const Beam* beams, int first, int count)
{
  BeamRun run{};
  run.middle = beams[first + count / 2];
  run.first = first;
  run.count = count;
  Beam& m = run.middle;
  for (int n = first; n < first + count; ++n)
  {
    const Beam& b = beams[n];
    const Vec3f q = b.origin - m.origin;
    run.originsMm = larger(run.originsMm, glm::length(q));
    run.apartMm =
      glm::max(run.apartMm, glm::abs(Vec3f(glm::dot(q, m.axis), glm::dot(q, m.lateral), glm::dot(q, m.elevation))));
    run.turn = glm::max(run.turn, Vec3f(glm::distance(b.axis, m.axis), glm::distance(b.lateral, m.lateral),
                                        glm::distance(b.elevation, m.elevation)));
    m.lateralCosine = smaller(m.lateralCosine, b.lateralCosine);
    m.elevationalCosine = smaller(m.elevationalCosine, b.elevationalCosine);
    m.profile.lateral.cosine2 = smaller(m.profile.lateral.cosine2, b.profile.lateral.cosine2);
    m.profile.elevational.cosine2 = smaller(m.profile.elevational.cosine2, b.profile.elevational.cosine2);
  }
  return run;
}

/// The least that 1 / s^2 of one axis may be between two depths: transmit rises to a focus and falls, receive falls.
SONO_HD inline float leastPerSquare(const ApertureAxis& a, float nearMm, float farMm)
{
  const float near = perTransmit2(a, nearMm);
  const float far = perTransmit2(a, farMm);
  return (smaller(near, far) + smaller(perReceive2(a, nearMm, near), perReceive2(a, farMm, far))) * a.cosine2;
}

/// Whether some beam of the run might: true where mayHearSurface is for one of them.
SONO_HD inline bool someMayHearSurface(const Vec3f& position, const Vec3f& roughNormal, float radiusMm, int row,
                                       const BeamRun& run, const LineGrid& g, const SurfaceTable& table)
{
  constexpr float rounding = 1.0001f;
  const Beam& b = run.middle;
  const float length = glm::length(roughNormal);
  const float facing = fabsf(glm::dot(roughNormal, b.axis)) + rounding * run.turn.x * length;
  if (facing < smaller(table.rows[row].roughCosine, table.rows[row ^ 1].roughCosine) && length > 0.0f)
  {
    return false;
  }
  const Vec3f q = position - b.origin;
  const float distanceMm = glm::length(q) + run.originsMm;
  const Vec3f slackMm = rounding * (run.apartMm + run.turn * distanceMm + Vec3f(radiusMm));
  const float depthMm = glm::dot(q, b.axis);
  const float nearMm = depthMm - slackMm.x;
  const float farMm = depthMm + slackMm.x;
  if (farMm < 0.0f || nearMm * g.samplesPerMm > g.lastSample)
  {
    return false;
  }
  const float l = larger(0.0f, fabsf(glm::dot(q, b.lateral)) - slackMm.y);
  const float e = larger(0.0f, fabsf(glm::dot(q, b.elevation)) - slackMm.z);
  if (b.kind == BeamKind::Array)
  {
    return b.arraySight->sees(l * b.lateralCosine, e * b.elevationalCosine, nearMm, distanceMm + 2.0f * radiusMm);
  }
  if (b.kind == BeamKind::Aperture)
  {
    const float from = larger(0.0f, nearMm);
    const float to = larger(0.0f, farMm);
    return maySee(
      { leastPerSquare(b.profile.lateral, from, to), leastPerSquare(b.profile.elevational, from, to), 1.0f }, l, e);
  }
  return b.kind != BeamKind::Gaussian || maySee(gaussianAt(b, 0.0f), l, e);
}

} // namespace sono
