#pragma once

#include "Kernel/Vec.h"

#include <vector>

namespace sono {

/// Scatterers side by side, local mm.
struct ScattererList
{
  std::vector<float> x, y, z, amplitude;

  int count() const { return int(x.size()); }
  void clear();
  void add(const Vec3f& position, float a);
};

/// A main beam with a Gaussian profile: w = exp(-(dL^2 / sL^2 + dE^2 / sE^2) / 2).
struct GaussianBeam
{
  Vec3f origin;
  Vec3f axis;
  Vec3f lateral;
  Vec3f elevation;
  float lateralSigmaMm;
  float elevationalSigmaMm;
};

/// Beyond this many sigma a scatterer is not seen: it would add less than exp(-16/2) of its amplitude.
constexpr float beamCutSigma = 4.0f;

/// A line's scatterer sum before the pulse: re[s] + i im[s] = sum of w a exp(-i 2 k (r - r_s)), each scatterer split
/// linearly between the two samples around its depth r, with its exact phase in both.
struct LineSum
{
  std::vector<float> re, im;
  float sampleMm = 0.0f;
  float radPerMm = 0.0f; ///< 2 k
};

void splat(const ScattererList& scatterers, const GaussianBeam& beam, LineSum& sum);

} // namespace sono
