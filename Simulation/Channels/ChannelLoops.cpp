#include "Channels/ChannelLoops.h"

#include "Core/Simd.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace sono {

namespace {

constexpr int B = channelBlock;

/// Nearer to the face E turns too fast with the frequency for a curve over those of a chunk: of the A4C it would be
/// 0.5 % off, and is 1e-5.
constexpr float nearMm = 30.0f;

/// Numbers that are computed together.
typedef float Lanes __attribute__((vector_size(vectorWidth * sizeof(float))));

// Vectors are handed over by reference: by value it would depend on the processor how.
inline void load(const float* from, Lanes& lanes)
{
  std::memcpy(&lanes, from, sizeof lanes);
}
inline void keep(const Lanes& lanes, float* to)
{
  std::memcpy(to, &lanes, sizeof lanes);
}

/// Lane i becomes the sum of two of a, i and i + half, or of b where i has that bit.
template<int half, int... i>
inline void halve(Lanes& a, const Lanes& b, std::integer_sequence<int, i...>)
{
  a = __builtin_shufflevector(a, b, ((i & half) ? vectorWidth + i - half : i)...) +
      __builtin_shufflevector(a, b, ((i & half) ? vectorWidth + i : i + half)...);
}

template<int half>
inline void halve(Lanes* parts)
{
  for (int n = 0; n < half; ++n)
  {
    halve<half>(parts[n], parts[n + half], std::make_integer_sequence<int, vectorWidth>());
  }
}

/// Number s is the sum of all lanes of part s. There are as many parts as lanes.
inline void sumEach(Lanes* parts, float* sums)
{
  static_assert(vectorWidth == 16 && B == vectorWidth, "four halvings");
  halve<8>(parts);
  halve<4>(parts);
  halve<2>(parts);
  halve<1>(parts);
  keep(parts[0], sums);
}

/// By point of a block.
struct BlockOf
{
  float v[B];
};

/// E over 1/r at a frequency, by power and point.
struct ElevationOf
{
  BlockOf re[ComplexCurve::nodes], im[ComplexCurve::nodes];
};

/// G without E of all elements at the first frequency, and the spans of 1/r.
inline void begin(const ChannelChunk& c, const ChannelBlock& points, ChannelRoom& room, BlockOf& middle, BlockOf& half)
{
  const int padded = c.padded;
  const int pieces = c.perElement;
  const float perPiece = 1.0f / float(pieces);
  const float firstWaves = c.firstMHz * c.shape.wavesPerMm;
  const float stepWaves = c.stepMHz * c.shape.wavesPerMm;
  const float firstNp = c.firstMHz * c.npPerMmMHz;
  const float stepNp = c.stepMHz * c.npPerMmMHz;
  for (int s = 0; s < B; ++s)
  {
    float* perR = room.perRange.data() + std::ptrdiff_t(s) * padded;
    std::fill(perR, perR + padded, 0.0f);
    const float x = points.x[s], y = points.y[s], z = points.z[s];
    for (int p = 0; p < pieces; ++p)
    {
      const std::ptrdiff_t at = (std::ptrdiff_t(s) * pieces + p) * padded;
      float *wRe = room.waveRe.data() + at, *wIm = room.waveIm.data() + at;
      float *sRe = room.stepRe.data() + at, *sIm = room.stepIm.data() + at;
      float* across2 = room.across2.data() + at;
      const std::ptrdiff_t first = std::ptrdiff_t(p) * padded;
      const float *px = c.pieceX + first, *pz = c.pieceZ + first;
      const float *nx = c.pieceNormalX + first, *nz = c.pieceNormalZ + first;
#pragma GCC ivdep
      for (int n = 0; n < padded; ++n)
      {
        const PieceSight sight =
          pieceSees({ px[n], pz[n], nx[n], nz[n] }, c.halfWidthMm, c.isSoft, c.isFlat, c.shortestMm, x, y, z);
        const ComplexNumber start = turned(sight.rangeMm * firstWaves);
        const ComplexNumber step = turned(sight.rangeMm * stepWaves);
        const float size = sight.size * perPiece * expNegative(-firstNp * sight.rangeMm);
        const float left = expNegative(-stepNp * sight.rangeMm);
        wRe[n] = size * start.re;
        wIm[n] = size * start.im;
        sRe[n] = left * step.re;
        sIm[n] = left * step.im;
        across2[n] = sight.halfAcross2;
        perR[n] += sight.rangeMm * perPiece;
      }
    }
    float low = 3e38f;
    float high = 0.0f;
    for (int n = 0; n < c.elements; ++n)
    {
      low = smaller(low, perR[n]);
      high = larger(high, perR[n]);
    }
    const InverseRange span{ 0.5f * (1.0f / low + 1.0f / high), larger(1e-7f, 0.5f * (1.0f / low - 1.0f / high)) };
    middle.v[s] = span.middle;
    half.v[s] = span.half;
#pragma GCC ivdep
    for (int n = 0; n < padded; ++n)
    {
      perR[n] = span.at(1.0f / larger(perR[n], c.shortestMm));
    }
  }
}

inline void elevationAt(const ChannelChunk& c, const ChannelBlock& points, float frequencyMHz, const BlockOf& middle,
                        const BlockOf& half, ElevationOf& out)
{
  const float waves = frequencyMHz * c.shape.wavesPerMm;
#pragma GCC ivdep
  for (int s = 0; s < B; ++s)
  {
    const ComplexCurve e = elevationCurve(c.shape, waves, points.y[s], { middle.v[s], half.v[s] });
    for (int n = 0; n < ComplexCurve::nodes; ++n)
    {
      out.re[n].v[s] = e.c[n].re;
      out.im[n].v[s] = e.c[n].im;
    }
  }
}

/// Values at the nodes of a block's frequencies become factors of their powers.
inline void alongFrequency(ElevationOf* nodes)
{
  for (int n = 0; n < ComplexCurve::nodes; ++n)
  {
    for (BlockOf(ElevationOf::*part)[ComplexCurve::nodes] : { &ElevationOf::re, &ElevationOf::im })
    {
      for (int s = 0; s < B; ++s)
      {
        float v[ComplexCurve::nodes];
        for (int node = 0; node < ComplexCurve::nodes; ++node)
        {
          v[node] = (nodes[node].*part)[n].v[s];
        }
        curveThrough(v);
        for (int node = 0; node < ComplexCurve::nodes; ++node)
        {
          (nodes[node].*part)[n].v[s] = v[node];
        }
      }
    }
  }
}

/// G of a point's elements at frequency number `bin`, and the waves on to the next.
inline void hear(const ChannelChunk& c, ChannelRoom& room, int s, float frequencyMHz, const ComplexCurve& e, float* hRe,
                 float* hIm)
{
  const int padded = c.padded;
  const float k = 6.2831853f * frequencyMHz * c.shape.wavesPerMm;
  const float k2 = k * k;
  for (int p = 0; p < c.perElement; ++p)
  {
    const std::ptrdiff_t at = (std::ptrdiff_t(s) * c.perElement + p) * padded;
    float *wRe = room.waveRe.data() + at, *wIm = room.waveIm.data() + at;
    const float *sRe = room.stepRe.data() + at, *sIm = room.stepIm.data() + at;
    const float* across2 = room.across2.data() + at;
    const float before = p == 0 ? 0.0f : 1.0f;
#pragma GCC ivdep
    for (int n = 0; n < padded; ++n)
    {
      const float width = sincOfSquare(k2 * across2[n]);
      const float re = wRe[n];
      const float im = wIm[n];
      hRe[n] = before * hRe[n] + width * re;
      hIm[n] = before * hIm[n] + width * im;
      wRe[n] = re * sRe[n] - im * sIm[n];
      wIm[n] = re * sIm[n] + im * sRe[n];
    }
  }
  if (!c.isFlat)
  {
    const float* place = room.perRange.data() + std::ptrdiff_t(s) * padded;
#pragma GCC ivdep
    for (int n = 0; n < padded; ++n)
    {
      const ComplexNumber heard = ComplexNumber{ hRe[n], hIm[n] } * e.at(place[n]);
      hRe[n] = heard.re;
      hIm[n] = heard.im;
    }
  }
}

/// What reaches a block's points from all elements that send.
inline void arrive(const float* dRe, const float* dIm, const float* heardRe, const float* heardIm, int padded,
                   BlockOf& outRe, BlockOf& outIm)
{
  Lanes partRe[B];
  Lanes partIm[B];
  for (int s = 0; s < B; ++s)
  {
    const float* hRe = heardRe + std::ptrdiff_t(s) * padded;
    const float* hIm = heardIm + std::ptrdiff_t(s) * padded;
    Lanes re{};
    Lanes im{};
    for (int n = 0; n < padded; n += vectorWidth)
    {
      Lanes sentRe, sentIm, gRe, gIm;
      load(dRe + n, sentRe);
      load(dIm + n, sentIm);
      load(hRe + n, gRe);
      load(hIm + n, gIm);
      re += sentRe * gRe - sentIm * gIm;
      im += sentRe * gIm + sentIm * gRe;
    }
    partRe[s] = re;
    partIm[s] = im;
  }
  sumEach(partRe, outRe.v);
  sumEach(partIm, outIm.v);
}

/// The amplitudes of a block's points at a frequency, and what takes them to the next.
struct Amplitudes
{
  BlockOf re, im, stepRe, stepIm;
};

inline void beginAmplitudes(const ChannelChunk& c, const ChannelBlock& points, Amplitudes& a)
{
  for (int s = 0; s < B; ++s)
  {
    const float waves = 2.0f * points.lagMm[s] * c.shape.wavesPerMm;
    const ComplexNumber start = turned(waves * c.firstMHz) * ComplexNumber{ points.re[s], points.im[s] };
    const ComplexNumber step = turned(waves * c.stepMHz);
    const float size = expf(-points.sinkNp[s] * (c.firstMHz - c.centreMHz));
    const float left = expf(-points.sinkNp[s] * c.stepMHz);
    a.re.v[s] = size * start.re;
    a.im.v[s] = size * start.im;
    a.stepRe.v[s] = left * step.re;
    a.stepIm.v[s] = left * step.im;
  }
}

inline void advance(Amplitudes& a)
{
  for (int s = 0; s < B; ++s)
  {
    const float re = a.re.v[s];
    const float im = a.im.v[s];
    a.re.v[s] = re * a.stepRe.v[s] - im * a.stepIm.v[s];
    a.im.v[s] = re * a.stepIm.v[s] + im * a.stepRe.v[s];
  }
}

/// Adds to one transmit's sums what each element hears of the points.
inline void addHeard(const BlockOf& echoRe, const BlockOf& echoIm, const float* hRe, const float* hIm, int padded,
                     float* sumRe, float* sumIm)
{
  for (int n = 0; n < padded; n += vectorWidth)
  {
    Lanes re, im;
    load(sumRe + n, re);
    load(sumIm + n, im);
    for (int s = 0; s < B; ++s)
    {
      Lanes gRe, gIm;
      load(hRe + std::ptrdiff_t(s) * padded + n, gRe);
      load(hIm + std::ptrdiff_t(s) * padded + n, gIm);
      re += echoRe.v[s] * gRe - echoIm.v[s] * gIm;
      im += echoRe.v[s] * gIm + echoIm.v[s] * gRe;
    }
    keep(re, sumRe + n);
    keep(im, sumIm + n);
  }
}

SONO_SIMD_CLONES __attribute__((flatten)) void add(const ChannelChunk& chunk, const ChannelBlock& block,
                                                   ChannelRoom& room, float* sums)
{
  const ChannelChunk c = chunk;
  BlockOf middle, half;
  begin(c, block, room, middle, half);
  Amplitudes amplitudes;
  beginAmplitudes(c, block, amplitudes);
  bool isNear = false;
  for (int s = 0; s < B; ++s)
  {
    isNear = isNear || (middle.v[s] + half.v[s]) * nearMm > 1.0f;
  }
  ElevationOf elevation[ComplexCurve::nodes]; // by power of the frequency
  const float centre = 0.5f * (channelBins - 1);
  for (int node = 0; node < ComplexCurve::nodes && !c.isFlat && !isNear; ++node)
  {
    elevationAt(c, block, c.firstMHz + (1.0f + ComplexCurve::place(node)) * centre * c.stepMHz, middle, half,
                elevation[node]);
  }
  if (!c.isFlat && !isNear)
  {
    alongFrequency(elevation);
  }
  for (int bin = 0; bin < c.bins; ++bin)
  {
    const float frequencyMHz = c.firstMHz + float(bin) * c.stepMHz;
    const float at = isNear ? 0.0f : (float(bin) - centre) / centre;
    if (!c.isFlat && isNear)
    {
      elevationAt(c, block, frequencyMHz, middle, half, elevation[0]);
      std::fill(elevation + 1, elevation + ComplexCurve::nodes, ElevationOf{});
    }
    for (int s = 0; s < B; ++s)
    {
      ComplexCurve e{};
      for (int n = 0; n < ComplexCurve::nodes && !c.isFlat; ++n)
      {
        e.c[n] = { elevation[4].re[n].v[s], elevation[4].im[n].v[s] };
        for (int power = 3; power >= 0; --power)
        {
          e.c[n] = { elevation[power].re[n].v[s] + at * e.c[n].re, elevation[power].im[n].v[s] + at * e.c[n].im };
        }
      }
      const std::ptrdiff_t row = std::ptrdiff_t(s) * c.padded;
      hear(c, room, s, frequencyMHz, e, room.heardRe.data() + row, room.heardIm.data() + row);
    }
    BlockOf sizeRe, sizeIm;
    for (int s = 0; s < B; ++s)
    {
      const float size = 1.0f + block.rise[s] * (frequencyMHz / c.centreMHz - 1.0f);
      sizeRe.v[s] = size * amplitudes.re.v[s];
      sizeIm.v[s] = size * amplitudes.im.v[s];
    }
    for (int t = 0; t < c.transmits; ++t)
    {
      const std::ptrdiff_t row = (std::ptrdiff_t(bin) * c.transmits + t) * 2 * c.padded;
      BlockOf echoRe, echoIm;
      arrive(c.drive + row, c.drive + row + c.padded, room.heardRe.data(), room.heardIm.data(), c.padded, echoRe,
             echoIm);
      for (int s = 0; s < B; ++s)
      {
        const ComplexNumber echo =
          ComplexNumber{ echoRe.v[s], echoIm.v[s] } * ComplexNumber{ sizeRe.v[s], sizeIm.v[s] };
        echoRe.v[s] = echo.re;
        echoIm.v[s] = echo.im;
      }
      addHeard(echoRe, echoIm, room.heardRe.data(), room.heardIm.data(), c.padded, sums + row, sums + row + c.padded);
    }
    advance(amplitudes);
  }
}

} // namespace

ChannelRoom::ChannelRoom(int padded, int perElement)
{
  const std::size_t elements = std::size_t(channelBlock) * std::size_t(padded);
  for (std::vector<float>* values : { &waveRe, &waveIm, &stepRe, &stepIm, &across2 })
  {
    values->resize(elements * std::size_t(perElement));
  }
  for (std::vector<float>* values : { &perRange, &heardRe, &heardIm })
  {
    values->resize(elements);
  }
}

void addBlock(const ChannelChunk& chunk, const ChannelBlock& block, ChannelRoom& room, float* sums)
{
  add(chunk, block, room, sums);
}

} // namespace sono
