#include "Echo/BeamSplat.h"

#include "Kernel/FastMath.h"
#include "Simd.h"

#include <algorithm>
#include <array>

namespace sono {

namespace {

constexpr int chunk = 64;

struct Splats
{
  std::array<std::int32_t, chunk> sample;
  std::array<float, chunk> re0, im0, re1, im1;
};

/// Where each scatterer falls and what it adds there; sample = -1 where the beam does not see it.
SONO_SIMD_CLONES void weigh(const float* x, const float* y, const float* z, const float* amplitude, int count,
                            const GaussianBeam& b, float perMm, float radPerSample, int samples, Splats& out)
{
  const float il = 1.0f / b.lateralSigmaMm;
  const float ie = 1.0f / b.elevationalSigmaMm;
  const float turnRe = cosSmall(radPerSample);
  const float turnIm = sinSmall(radPerSample);
  for (int i = 0; i < count; ++i)
  {
    const float px = x[i] - b.origin.x;
    const float py = y[i] - b.origin.y;
    const float pz = z[i] - b.origin.z;
    const float position = (px * b.axis.x + py * b.axis.y + pz * b.axis.z) * perMm;
    const float dl = (px * b.lateral.x + py * b.lateral.y + pz * b.lateral.z) * il;
    const float de = (px * b.elevation.x + py * b.elevation.y + pz * b.elevation.z) * ie;
    const float squared = dl * dl + de * de;
    const float a = amplitude[i] * expNegative(-0.5f * squared);
    const float whole = std::floor(position);
    const float fraction = position - whole;
    const float phase = radPerSample * fraction;
    const float re = a * cosSmall(phase);
    const float im = -a * sinSmall(phase);
    out.re0[i] = re * (1.0f - fraction);
    out.im0[i] = im * (1.0f - fraction);
    // Seen from the next sample the phase is one sample's turn ahead.
    out.re1[i] = (re * turnRe - im * turnIm) * fraction;
    out.im1[i] = (re * turnIm + im * turnRe) * fraction;
    const bool seen = (squared < beamCutSigma * beamCutSigma) & (whole >= 0.0f) & (whole < float(samples - 1));
    out.sample[i] = seen ? std::int32_t(whole) : -1;
  }
}

} // namespace

void ScattererList::clear()
{
  x.clear();
  y.clear();
  z.clear();
  amplitude.clear();
}

void ScattererList::add(const Vec3f& position, float a)
{
  x.push_back(position.x);
  y.push_back(position.y);
  z.push_back(position.z);
  amplitude.push_back(a);
}

void splat(const ScattererList& scatterers, const GaussianBeam& beam, LineSum& sum)
{
  const int samples = int(sum.re.size());
  Splats splats;
  for (int first = 0; first < scatterers.count(); first += chunk)
  {
    const int count = std::min(chunk, scatterers.count() - first);
    weigh(scatterers.x.data() + first, scatterers.y.data() + first, scatterers.z.data() + first,
          scatterers.amplitude.data() + first, count, beam, 1.0f / sum.sampleMm, sum.radPerMm * sum.sampleMm, samples,
          splats);
    for (int i = 0; i < count; ++i)
    {
      const std::int32_t s = splats.sample[std::size_t(i)];
      if (s >= 0)
      {
        sum.re[std::size_t(s)] += splats.re0[std::size_t(i)];
        sum.im[std::size_t(s)] += splats.im0[std::size_t(i)];
        sum.re[std::size_t(s) + 1] += splats.re1[std::size_t(i)];
        sum.im[std::size_t(s) + 1] += splats.im1[std::size_t(i)];
      }
    }
  }
}

} // namespace sono
