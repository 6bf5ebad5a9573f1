#include "Echo/BeamSplat.h"

#include "Core/Simd.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace sono {

namespace {

constexpr int chunk = 4 * vectorWidth;

/// What each scatterer of a chunk adds, (re, im) to the sample before it and to the one behind it.
struct Splats
{
  std::int32_t sample[chunk];
  float added[4][chunk];
};

inline BeamPlace placeOf(const ScattererView& v, int i, const Beam& b, const LineGrid& g)
{
  return placeInBeam(v.x[i], v.y[i], v.z[i], b, g);
}

inline void split(float a, float position, bool seen, const LineGrid& g, int i, Splats& out)
{
  const ScattererSplit s = splitScatterer(a, position, g);
  for (int c = 0; c < 4; ++c)
  {
    out.added[c][i] = s.added[c];
  }
  out.sample[i] = seen ? std::int32_t(s.sample) : 0;
}

/// Where each scatterer falls and what it adds there; nothing, to sample 0, where the beam does not see it.
SONO_SIMD_CLONES void weigh(const ScattererView v, int first, int count, const Beam b, LineGrid g, Splats& out)
{
  const float il = 1.0f / b.lateralSigmaMm;
  const float ie = 1.0f / b.elevationalSigmaMm;
  for (int i = 0; i < count; ++i)
  {
    const BeamPlace p = placeOf(v, first + i, b, g);
    const float squared = squaredSigmas(p, il, ie);
    const bool seen = (squared < beamCutSigma * beamCutSigma) & (p.position >= 0.0f) & (p.position < g.lastSample);
    split(seen ? v.scale * v.amplitude[first + i] * expNegative(-0.5f * squared) : 0.0f, p.position, seen, g, i, out);
  }
}

/// The same with the Gaussians of an aperture, of which it is known through what each axis receives: a loop that asks
/// is no vector loop.
template<bool lateralLens, bool elevationalLens>
inline void weighByProfile(const ScattererView& v, int first, int count, const Beam& b, const LineGrid& g, Splats& out)
{
  const float mmPerSample = 1.0f / g.samplesPerMm;
  ApertureProfile profile = b.profile;
  profile.lateral.lens = lateralLens;
  profile.elevational.lens = elevationalLens;
  for (int i = 0; i < count; ++i)
  {
    const BeamPlace p = placeOf(v, first + i, b, g);
    const ProfileAt at = profileAt(profile, p.position * mmPerSample);
    const float squared = p.lateral * p.lateral * at.perLateral2 + p.elevational * p.elevational * at.perElevational2;
    const bool seen = (squared < beamCutSigma * beamCutSigma) & (p.position >= 0.0f) & (p.position < g.lastSample);
    const float weight = at.amplitude * expNegative(-0.5f * squared);
    split(seen ? v.scale * v.amplitude[first + i] * weight : 0.0f, p.position, seen, g, i, out);
  }
}

SONO_SIMD_CLONES __attribute__((flatten)) void weighByAperture(const ScattererView v, int first, int count,
                                                               const Beam b, LineGrid g, Splats& out)
{
  if (b.profile.lateral.lens)
  {
    b.profile.elevational.lens ? weighByProfile<true, true>(v, first, count, b, g, out)
                               : weighByProfile<true, false>(v, first, count, b, g, out);
  }
  else
  {
    b.profile.elevational.lens ? weighByProfile<false, true>(v, first, count, b, g, out)
                               : weighByProfile<false, false>(v, first, count, b, g, out);
  }
}

/// beamFieldCell without a branch. The share is between 0 and 1 outside of the table, too.
inline BeamFieldCell cellOf(const BeamFieldAxis& axis, float fold, float positionMm)
{
  const float p = std::max(positionMm, fold * positionMm); // |position| where the table is mirrored
  const bool inside = (p >= axis.lowMm) & (p <= axis.highMm);
  const float lastCell = float(axis.lastCell);
  const float place = std::min(std::max(0.0f, (p - axis.minMm) * axis.perMm), lastCell + 1.0f);
  const float cell = std::min(std::floor(place), lastCell);
  return { std::int32_t(cell), place - cell, inside };
}

/// The same with a field. Arrays of its own between the loops let the compiler see that the lookups do not touch what
/// is written.
SONO_SIMD_CLONES void weighByField(const ScattererView v, int first, int count, const Beam b, const BeamFieldView f,
                                   LineGrid g, Splats& out)
{
  std::int32_t value[chunk];
  float position[chunk], lateral[chunk], elevational[chunk], depth[chunk], weight[chunk];
  const float mmPerSample = 1.0f / g.samplesPerMm;
  const float foldLateral = f.lateral.mirrored ? -1.0f : 1.0f;
  const float foldElevational = f.elevational.mirrored ? -1.0f : 1.0f;
  const float* values = f.values;
  const int la = f.lateral.stride;
  const int el = f.elevational.stride;
  const int de = f.depth.stride;
  for (int i = 0; i < count; ++i)
  {
    const BeamPlace p = placeOf(v, first + i, b, g);
    const BeamFieldCell l = cellOf(f.lateral, foldLateral, p.lateral);
    const BeamFieldCell e = cellOf(f.elevational, foldElevational, p.elevational);
    const BeamFieldCell d = cellOf(f.depth, 1.0f, std::min(p.position * mmPerSample, f.depth.highMm));
    const bool seen = l.inside & e.inside & d.inside & (p.position >= 0.0f) & (p.position < g.lastSample);
    value[i] = l.index + e.index * el + d.index * de;
    lateral[i] = l.share;
    elevational[i] = e.share;
    depth[i] = d.share;
    position[i] = p.position;
    weight[i] = seen ? v.scale * v.amplitude[first + i] : 0.0f;
  }
  for (int i = 0; i < count; ++i)
  {
    const int n = value[i];
    const float nearLow = values[n] + lateral[i] * (values[n + la] - values[n]);
    const float nearHigh = values[n + el] + lateral[i] * (values[n + el + la] - values[n + el]);
    const float farLow = values[n + de] + lateral[i] * (values[n + de + la] - values[n + de]);
    const float farHigh = values[n + de + el] + lateral[i] * (values[n + de + el + la] - values[n + de + el]);
    const float near = nearLow + elevational[i] * (nearHigh - nearLow);
    const float far = farLow + elevational[i] * (farHigh - farLow);
    weight[i] *= near + depth[i] * (far - near);
  }
  for (int i = 0; i < count; ++i)
  {
    split(weight[i], position[i], weight[i] != 0.0f, g, i, out);
  }
}

/// Flat index of the value before a place in an array's table, and the share of the next; without a branch.
inline ArrayBeamCell flatCell(const ArrayBeamAxis& axis, float rangeRow, float mm, float perRange)
{
  const float place = std::fabs(mm) * axis.perUnit * perRange;
  const float last = float(axis.count - 1);
  const float held = std::min(place, last);
  const float cell = std::min(std::floor(held), last - 1.0f);
  return { std::int32_t(2.0f * (rangeRow * float(axis.count) + cell)), held - cell, place <= last };
}

/// The same with an array's complex beam, whose echoes come from the range.
SONO_SIMD_CLONES void weighByArray(const ScattererView v, int first, int count, const Beam b, const ArrayBeamView f,
                                   LineGrid g, Splats& out)
{
  std::int32_t lateral[chunk], elevational[chunk];
  float lateralShare[chunk], elevationalShare[chunk], rangeShare[chunk], position[chunk], amplitude[chunk];
  ComplexWeight weight[chunk];
  const float mmPerSample = 1.0f / g.samplesPerMm;
  const float lastRange = float(f.rangeCount - 1);
  for (int i = 0; i < count; ++i)
  {
    const BeamPlace p = placeOf(v, first + i, b, g);
    const float z = p.position * mmPerSample;
    const float range = std::sqrt(z * z + p.lateral * p.lateral + p.elevational * p.elevational);
    const float row = std::min(range * f.rangesPerMm, lastRange);
    const float before = std::min(std::floor(row), lastRange - 1.0f);
    const ArrayBeamCell l =
      flatCell(f.lateral, before, p.lateral * b.lateralCosine, 1.0f / std::max(range, f.lateral.nearMm));
    const ArrayBeamCell e = flatCell(f.elevational, before, p.elevational * b.elevationalCosine,
                                     1.0f / std::max(range, f.elevational.nearMm));
    const float at = range * g.samplesPerMm;
    const bool seen = l.inside & e.inside & (p.position >= 0.0f) & (at < g.lastSample);
    lateral[i] = l.index;
    elevational[i] = e.index;
    lateralShare[i] = l.share;
    elevationalShare[i] = e.share;
    rangeShare[i] = row - before;
    position[i] = at;
    amplitude[i] = seen ? v.scale * b.gain * v.amplitude[first + i] : 0.0f;
  }
  const int lateralRow = 2 * f.lateral.count;
  const int elevationalRow = 2 * f.elevational.count;
  for (int i = 0; i < count; ++i)
  {
    const ComplexWeight l = arrayBeamValue(f.lateral.values + lateral[i], lateralRow, lateralShare[i], rangeShare[i]);
    const ComplexWeight e =
      arrayBeamValue(f.elevational.values + elevational[i], elevationalRow, elevationalShare[i], rangeShare[i]);
    weight[i] = { amplitude[i] * (l.re * e.re - l.im * e.im), amplitude[i] * (l.re * e.im + l.im * e.re) };
  }
  for (int i = 0; i < count; ++i)
  {
    const ScattererSplit s = splitScatterer(weight[i], position[i], g);
    for (int c = 0; c < 4; ++c)
    {
      out.added[c][i] = s.added[c];
    }
    out.sample[i] = amplitude[i] != 0.0f ? std::int32_t(s.sample) : 0;
  }
}

/// At most `chunk` of them.
void splatChunk(const ScattererView& scatterers, int first, int count, const Beam& beam, const LineGrid& grid,
                LineSum& sum)
{
  Splats splats;
  const int weighed = scatterers.isPadded ? inWholeVectors(count) : count;
  switch (beam.kind)
  {
    case BeamKind::Gaussian:
      weigh(scatterers, first, weighed, beam, grid, splats);
      break;
    case BeamKind::Aperture:
      weighByAperture(scatterers, first, weighed, beam, grid, splats);
      break;
    case BeamKind::Field:
      weighByField(scatterers, first, weighed, beam, *beam.field, grid, splats);
      break;
    case BeamKind::Array:
      weighByArray(scatterers, first, weighed, beam, *beam.array, grid, splats);
      break;
  }
  for (int i = 0; i < count; ++i)
  {
    float* to = sum.iq.data() + 2 * std::size_t(splats.sample[i]);
    float sum4[4];
    for (int c = 0; c < 4; ++c) // adjacent: one vector addition
    {
      sum4[c] = to[c] + splats.added[c][i];
    }
    std::copy_n(sum4, 4, to);
  }
}

} // namespace

void splat(const ScattererView& scatterers, const Beam& beam, const LineGrid& grid, LineSum& sum)
{
  for (int first = 0; first < scatterers.count; first += chunk)
  {
    splatChunk(scatterers, first, std::min(chunk, scatterers.count - first), beam, grid, sum);
  }
}

} // namespace sono
