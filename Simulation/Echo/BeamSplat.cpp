#include "Echo/BeamSplat.h"

#include "Kernel/FastMath.h"
#include "Simd.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace sono {

namespace {

constexpr int chunk = 64;

/// What each scatterer of a chunk adds, (re, im) to the sample before it and to the one behind it.
struct Splats
{
  std::int32_t sample[chunk];
  float added[chunk][4];
};

/// The sampling of a line as the inner loop wants it.
struct LineGrid
{
  float samplesPerMm;
  float radPerSample;
  float halfTurnRe; ///< exp(i radPerSample / 2)
  float halfTurnIm;
  float lastSample;
};

/// Where each scatterer falls and what it adds there; nothing, to sample 0, where the beam does not see it.
SONO_SIMD_CLONES void weigh(const ScattererView v, int first, int count, const GaussianBeam b, LineGrid g, Splats& out)
{
  const float il = 1.0f / b.lateralSigmaMm;
  const float ie = 1.0f / b.elevationalSigmaMm;
  for (int i = 0; i < count; ++i)
  {
    const float px = v.x[first + i] - b.origin.x;
    const float py = v.y[first + i] - b.origin.y;
    const float pz = v.z[first + i] - b.origin.z;
    const float position = (px * b.axis.x + py * b.axis.y + pz * b.axis.z) * g.samplesPerMm;
    const float dl = (px * b.lateral.x + py * b.lateral.y + pz * b.lateral.z) * il;
    const float de = (px * b.elevation.x + py * b.elevation.y + pz * b.elevation.z) * ie;
    const float squared = dl * dl + de * de;
    const float whole = std::floor(position);
    const float fraction = position - whole;
    const bool seen = (squared < beamCutSigma * beamCutSigma) & (whole >= 0.0f) & (whole < g.lastSample);
    const float a = seen ? v.amplitude[first + i] * expNegative(-0.5f * squared) : 0.0f;
    // Phase as seen from halfway between the two samples, which keeps it below pi / 2; each is half a turn away.
    const float phase = g.radPerSample * (fraction - 0.5f);
    const float re = a * cosSmall(phase);
    const float im = -a * sinSmall(phase);
    const float near = 1.0f - fraction;
    out.added[i][0] = (re * g.halfTurnRe + im * g.halfTurnIm) * near;
    out.added[i][1] = (im * g.halfTurnRe - re * g.halfTurnIm) * near;
    out.added[i][2] = (re * g.halfTurnRe - im * g.halfTurnIm) * fraction;
    out.added[i][3] = (im * g.halfTurnRe + re * g.halfTurnIm) * fraction;
    out.sample[i] = seen ? std::int32_t(whole) : 0;
  }
}

} // namespace

void splat(const ScattererView& scatterers, const GaussianBeam& beam, LineSum& sum)
{
  const double turn = sum.radPerMm * double(sum.sampleMm);
  const LineGrid grid{ 1.0f / sum.sampleMm, float(turn), float(std::cos(0.5 * turn)), float(std::sin(0.5 * turn)),
                       float(sum.sampleCount() - 1) };
  Splats splats;
  for (int first = 0; first < scatterers.count; first += chunk)
  {
    const int count = std::min(chunk, scatterers.count - first);
    weigh(scatterers, first, count, beam, grid, splats);
    for (int i = 0; i < count; ++i)
    {
      float* to = sum.iq.data() + 2 * std::size_t(splats.sample[i]);
      for (int c = 0; c < 4; ++c) // adjacent: one vector addition
      {
        to[c] += splats.added[i][c];
      }
    }
  }
}

} // namespace sono
