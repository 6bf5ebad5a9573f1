#pragma once

#include "Kernel/ChannelWave.h"

// Channels on a device, several shells at once (Channels/ChannelPlan.h): what elements send, the sums over points, and
// signals of these.
//
// A block of threads sums a frequency of a shell for up to `tileTransmits` transmits: points go through shared memory
// by tiles, first what each element hears of each point (G), then what arrives at each point from each transmit, then
// both into the sums of transmits and elements, which the threads keep in registers.

namespace sono {
namespace {

constexpr int threads = 256;
constexpr int tilePoints = 16;
constexpr int tileTransmits = 16;
constexpr int tileElements = 64;
constexpr int sumsPerThread = tileTransmits * tileElements / threads;

struct DevicePoints
{
  const float *x, *y, *z, *re, *im, *lagMm, *sinkNp, *rise;
};

/// A shell's points, [first, end), and the first sample of its stretch.
struct DeviceShell
{
  int first;
  int end;
  int firstSample;
};

struct ShellJob
{
  const float *pieceX, *pieceZ, *pieceNormalX, *pieceNormalZ;
  int elements;
  int padded;
  int perElement;
  float halfWidthMm;
  bool isSoft;
  bool isFlat;
  float shortestMm;
  float npPerMmMHz;
  ElementShape shape;
  double stepMHz;
  int firstBin;
  float centreMHz;
  int transmits;
  const float* drive; ///< bins x transmits x (re, im of padded elements)
  DevicePoints points;
  const DeviceShell* shells;
  int elementTiles;
  int parts; ///< blocks that share the points of a frequency
};

/// A tile's points, and E over 1/r of each.
struct TilePoint
{
  float x, y, z;
  ComplexNumber amplitude;
  InverseRange span;
  ComplexCurve elevation;
};

__device__ float meanRange(const ShellJob& job, int n, float x, float y, float z)
{
  float sum = 0.0f;
  for (int p = 0; p < job.perElement; ++p)
  {
    const int at = p * job.padded + n;
    sum += pieceSees({ job.pieceX[at], job.pieceZ[at], job.pieceNormalX[at], job.pieceNormalZ[at] }, job.halfWidthMm,
                     job.isSoft, job.isFlat, job.shortestMm, x, y, z)
             .rangeMm;
  }
  return sum / float(job.perElement);
}

/// A point whose nearest and furthest elements are so far away.
__device__ TilePoint pointAt(const ShellJob& job, int i, float frequencyMHz, float low, float high)
{
  TilePoint out;
  out.x = job.points.x[i];
  out.y = job.points.y[i];
  out.z = job.points.z[i];
  const ComplexNumber turn = turned(2.0f * job.points.lagMm[i] * job.shape.wavesPerMm * frequencyMHz);
  const float size = expf(-job.points.sinkNp[i] * (frequencyMHz - job.centreMHz)) *
                     (1.0f + job.points.rise[i] * (frequencyMHz / job.centreMHz - 1.0f));
  const ComplexNumber amplitude = turn * ComplexNumber{ job.points.re[i], job.points.im[i] };
  out.amplitude = { size * amplitude.re, size * amplitude.im };
  out.span = { 0.5f * (1.0f / low + 1.0f / high), larger(1e-7f, 0.5f * (1.0f / low - 1.0f / high)) };
  if (!job.isFlat)
  {
    out.elevation = elevationCurve(job.shape, frequencyMHz * job.shape.wavesPerMm, out.y, out.span);
  }
  return out;
}

/// G of an element and a point.
__device__ ComplexNumber heardBy(const ShellJob& job, int n, const TilePoint& point, float frequencyMHz)
{
  const float waves = frequencyMHz * job.shape.wavesPerMm;
  const float k = 6.2831853f * waves;
  ComplexNumber sum{ 0.0f, 0.0f };
  float range = 0.0f;
  for (int p = 0; p < job.perElement; ++p)
  {
    const int at = p * job.padded + n;
    const PieceSight sight =
      pieceSees({ job.pieceX[at], job.pieceZ[at], job.pieceNormalX[at], job.pieceNormalZ[at] }, job.halfWidthMm,
                job.isSoft, job.isFlat, job.shortestMm, point.x, point.y, point.z);
    const ComplexNumber turn = turned(sight.rangeMm * waves);
    const float size = sight.size * sincOfSquare(k * k * sight.halfAcross2) *
                       expNegative(-frequencyMHz * job.npPerMmMHz * sight.rangeMm);
    sum.re += size * turn.re;
    sum.im += size * turn.im;
    range += sight.rangeMm;
  }
  const float perPiece = 1.0f / float(job.perElement);
  sum = { sum.re * perPiece, sum.im * perPiece };
  return job.isFlat ? sum : sum * point.elevation.at(point.span.at(1.0f / (range * perPiece)));
}

/// blockIdx: x the frequency, y the shell and the tile of elements that are heard, z the tile of transmits and the part
/// of the points. `sums` are parts x shells x bins x transmits x (re, im of padded elements).
__global__ void __launch_bounds__(threads) sumShellKernel(ShellJob job, float* sums)
{
  extern __shared__ float2 heard[]; // points of a tile x padded elements
  __shared__ TilePoint points[tilePoints];
  __shared__ float2 arriving[tilePoints][tileTransmits];
  __shared__ float nearest[tilePoints];
  __shared__ float furthest[tilePoints];
  const int bin = int(blockIdx.x);
  const int part = int(blockIdx.z) % job.parts;
  const int firstTransmit = int(blockIdx.z) / job.parts * tileTransmits;
  const int transmits = min(tileTransmits, job.transmits - firstTransmit);
  const int shell = int(blockIdx.y) / job.elementTiles;
  const int firstElement = int(blockIdx.y) % job.elementTiles * tileElements;
  const float frequencyMHz = float((job.firstBin + bin) * job.stepMHz);
  const float* drive = job.drive + (size_t(bin) * job.transmits + firstTransmit) * 2 * job.padded;
  const int element = firstElement + int(threadIdx.x) % tileElements;
  const int ownTransmit = int(threadIdx.x) / tileElements;
  constexpr int transmitStep = threads / tileElements;
  float2 own[sumsPerThread];
  for (int n = 0; n < sumsPerThread; ++n)
  {
    own[n] = { 0.0f, 0.0f };
  }
  const DeviceShell mine = job.shells[shell];
  const int perPart = (mine.end - mine.first + job.parts - 1) / job.parts;
  const int begin = mine.first + part * perPart;
  const int end = min(begin + perPart, mine.end);
  for (int first = begin; first < end; first += tilePoints)
  {
    const int count = min(tilePoints, end - first);
    {
      // Sixteen lanes look for a point's nearest and furthest element.
      const int s = int(threadIdx.x) / 16;
      const int i = first + min(s, count - 1);
      float low = 3e38f;
      float high = 0.0f;
      for (int n = int(threadIdx.x) % 16; n < job.elements; n += 16)
      {
        const float range = meanRange(job, n, job.points.x[i], job.points.y[i], job.points.z[i]);
        low = fminf(low, range);
        high = fmaxf(high, range);
      }
      for (int width = 8; width > 0; width /= 2)
      {
        low = fminf(low, __shfl_xor_sync(0xffffffffu, low, width));
        high = fmaxf(high, __shfl_xor_sync(0xffffffffu, high, width));
      }
      if (threadIdx.x % 16 == 0)
      {
        nearest[s] = low;
        furthest[s] = high;
      }
    }
    __syncthreads();
    if (threadIdx.x < tilePoints)
    {
      const int s = int(threadIdx.x);
      points[s] = pointAt(job, first + min(s, count - 1), frequencyMHz, nearest[s], furthest[s]);
      if (s >= count)
      {
        points[s].amplitude = { 0.0f, 0.0f };
      }
    }
    __syncthreads();
    for (int at = int(threadIdx.x); at < tilePoints * job.padded; at += threads)
    {
      const int s = at / job.padded;
      const ComplexNumber g = heardBy(job, at - s * job.padded, points[s], frequencyMHz);
      heard[at] = { g.re, g.im };
    }
    __syncthreads();
    {
      // Sixteen lanes sum what arrives at a point.
      const int s = int(threadIdx.x) / 16;
      const int lane = int(threadIdx.x) % 16;
      for (int t = 0; t < transmits; ++t)
      {
        const float* re = drive + size_t(t) * 2 * job.padded;
        ComplexNumber sum{ 0.0f, 0.0f };
        for (int n = lane; n < job.padded; n += 16)
        {
          const float2 g = heard[s * job.padded + n];
          sum.re += re[n] * g.x - re[job.padded + n] * g.y;
          sum.im += re[n] * g.y + re[job.padded + n] * g.x;
        }
        for (int width = 8; width > 0; width /= 2)
        {
          sum.re += __shfl_xor_sync(0xffffffffu, sum.re, width);
          sum.im += __shfl_xor_sync(0xffffffffu, sum.im, width);
        }
        if (lane == 0)
        {
          const ComplexNumber echo = sum * points[s].amplitude;
          arriving[s][t] = { echo.re, echo.im };
        }
      }
    }
    __syncthreads();
    if (element < job.padded)
    {
      for (int s = 0; s < tilePoints; ++s)
      {
        const float2 g = heard[s * job.padded + element];
        for (int n = 0; n < sumsPerThread; ++n)
        {
          const int t = ownTransmit + n * transmitStep;
          if (t < transmits)
          {
            const float2 a = arriving[s][t];
            own[n].x += a.x * g.x - a.y * g.y;
            own[n].y += a.x * g.y + a.y * g.x;
          }
        }
      }
    }
    __syncthreads();
  }
  if (element >= job.padded)
  {
    return;
  }
  for (int n = 0; n < sumsPerThread; ++n)
  {
    const int t = ownTransmit + n * transmitStep;
    if (t < transmits)
    {
      const size_t row = (size_t(part) * (gridDim.y / job.elementTiles) + shell) * gridDim.x + bin;
      float* out = sums + (row * job.transmits + firstTransmit + t) * 2 * size_t(job.padded);
      out[element] = own[n].x;
      out[job.padded + element] = own[n].y;
    }
  }
}

/// The parts' sums, in their order.
__global__ void addParts(const float* parts, int count, size_t values, float* sums)
{
  const size_t i = size_t(blockIdx.x) * blockDim.x + threadIdx.x;
  if (i < values)
  {
    float sum = 0.0f;
    for (int part = 0; part < count; ++part)
    {
      sum += parts[size_t(part) * values + i];
    }
    sums[i] = sum;
  }
}

/// What elements send (driveTable), of delays in us; one thread for a frequency, transmit and element.
__global__ void driveKernel(const double* delays, const float* weights, double stepMHz, int firstBin, int bins,
                            int transmits, int elements, int padded, float* drive)
{
  const size_t i = size_t(blockIdx.x) * blockDim.x + threadIdx.x;
  const int n = int(i % padded);
  const int t = int(i / padded % transmits);
  const int bin = int(i / padded / transmits);
  if (bin >= bins)
  {
    return;
  }
  float sine = 0.0f;
  float cosine = 0.0f;
  float weight = 0.0f;
  if (n < elements)
  {
    const double turns = (firstBin + bin) * stepMHz * delays[t * elements + n];
    sincospif(2.0f * float(turns - rint(turns)), &sine, &cosine);
    weight = weights[t * elements + n];
  }
  float* re = drive + (size_t(bin) * transmits + t) * 2 * padded;
  re[n] = weight * cosine;
  re[padded + n] = weight * sine;
}

constexpr int synthSamples = 64;
constexpr int synthSignals = 32;
constexpr int synthBins = 32;
constexpr int signalsPerThread = synthSamples * synthSignals / threads;

struct SynthesisJob
{
  const DeviceShell* shells;
  int shellCount;
  int bins;
  int firstBin;
  int samples; ///< of a stretch
  int transmits;
  int elements;
  int padded;
  int sampleCount; ///< of a signal
  const float2* pulse;
  const float *turnCosine, *turnSine;
};

/// Sums of shells to samples (synthesise), added to the signals. blockIdx: x the tile of samples, y that of signals.
__global__ void __launch_bounds__(threads) synthesiseKernel(SynthesisJob job, const float* sums, float* rf)
{
  __shared__ float2 tones[synthBins][synthSamples];
  __shared__ float2 values[synthBins][synthSignals];
  const int signals = job.transmits * job.elements;
  const int firstSample = int(blockIdx.x) * synthSamples;
  const int firstSignal = int(blockIdx.y) * synthSignals;
  const int m = int(threadIdx.x) % synthSamples;
  constexpr int groups = threads / synthSamples;
  const int group = int(threadIdx.x) / synthSamples;
  float added[signalsPerThread] = {};
  for (int shell = 0; shell < job.shellCount; ++shell)
  {
    const int inStretch = firstSample - job.shells[shell].firstSample;
    if (inStretch >= job.samples || inStretch + synthSamples <= 0)
    {
      continue; // the same for the whole block
    }
    const float* shellSums = sums + size_t(shell) * job.bins * job.transmits * 2 * job.padded;
    const bool isMine = inStretch + m >= 0 && inStretch + m < job.samples;
    for (int first = 0; first < job.bins; first += synthBins)
    {
      for (int at = int(threadIdx.x); at < synthBins * synthSamples; at += threads)
      {
        const long long bin = job.firstBin + first + at / synthSamples;
        const int turn = int(bin * (firstSample + at % synthSamples) % job.samples);
        tones[at / synthSamples][at % synthSamples] = { job.turnCosine[turn], job.turnSine[turn] };
      }
      for (int at = int(threadIdx.x); at < synthBins * synthSignals; at += threads)
      {
        const int bin = first + at / synthSignals;
        const int signal = firstSignal + at % synthSignals;
        float2 value = { 0.0f, 0.0f };
        if (bin < job.bins && signal < signals)
        {
          const int t = signal / job.elements;
          const float* row =
            shellSums + (size_t(bin) * job.transmits + t) * 2 * job.padded + (signal - t * job.elements);
          const ComplexNumber sum =
            ComplexNumber{ job.pulse[bin].x, job.pulse[bin].y } * ComplexNumber{ row[0], row[job.padded] };
          value = { sum.re, sum.im };
        }
        values[at / synthSignals][at % synthSignals] = value;
      }
      __syncthreads();
      if (isMine)
      {
        for (int bin = 0; bin < synthBins; ++bin)
        {
          const float2 tone = tones[bin][m];
          for (int n = 0; n < signalsPerThread; ++n)
          {
            const float2 value = values[bin][group + n * groups];
            added[n] += value.x * tone.x + value.y * tone.y;
          }
        }
      }
      __syncthreads();
    }
  }
  if (firstSample + m >= job.sampleCount)
  {
    return;
  }
  for (int n = 0; n < signalsPerThread; ++n)
  {
    const int signal = firstSignal + group + n * groups;
    if (signal < signals)
    {
      rf[size_t(signal) * job.sampleCount + firstSample + m] += added[n];
    }
  }
}

} // namespace
} // namespace sono
