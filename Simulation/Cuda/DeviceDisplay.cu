#include "Cuda/DeviceDisplay.cuh"

#include "Image/BMode.h"
#include "Kernel/GreyByte.h"

#include <algorithm>

namespace sono {

namespace {

constexpr int threads = 256;

__device__ float withNoise(float envelope, float rms, float nodesPerSample, std::uint64_t seed, std::uint32_t line,
                           int sample)
{
  const float position = float(sample) * nodesPerSample;
  const int node = int(position);
  Vec2f nodes[4];
  for (int k = 0; k < 4; ++k)
  {
    nodes[k] = noiseNode(seed, line, std::uint32_t(node + k));
  }
  return noisyEnvelope(envelope, rms, nodes, position - float(node));
}

/// Without noise where its rms is 0, without haze where it has no nodes.
__global__ void addNoiseAndHaze(const float* envelope, float* received, std::size_t count, int lines, int samples,
                                float rms, float noiseNodesPerSample, std::uint64_t seed, const float* haze,
                                int hazeNodes, float hazeNodesPerSample)
{
  const std::size_t i = blockIdx.x * std::size_t(blockDim.x) + threadIdx.x;
  if (i >= count)
  {
    return;
  }
  const auto line = std::uint32_t((i / samples) % lines);
  const int sample = int(i % samples);
  float value = envelope[i];
  if (rms > 0.0f)
  {
    value = withNoise(value, rms, noiseNodesPerSample, seed, line, sample);
  }
  if (hazeNodes > 0)
  {
    value = hazyEnvelope(value, haze + std::size_t(line) * hazeNodes, float(sample) * hazeNodesPerSample);
  }
  received[i] = value;
}

/// Rows of `length` values, `stride` apart.
__global__ void smoothRows(const float* envelope, float* smoothed, std::size_t count, int length, int stride,
                           const float* weights, int half)
{
  const std::size_t i = blockIdx.x * std::size_t(blockDim.x) + threadIdx.x;
  if (i < count)
  {
    const int place = int(i / stride % length);
    smoothed[i] = smoothedEnvelope(envelope + (i - std::size_t(place) * stride), length, stride, place, weights, half);
  }
}

// The value of a rank is found from its highest bits down: 11, 10 and 10 of the 31 that a non-negative float has. A
// pass counts the values whose higher bits are those found so far; its last block picks the bin that holds the rank.
constexpr int passes = 3;
constexpr int passBits[passes] = { 11, 10, 10 };
constexpr int passShift[passes] = { 20, 10, 0 };
constexpr int binCount = 2048;

/// What is known of an image's rank; all zero at first.
struct RankState
{
  std::uint32_t bits;    // found so far
  std::uint32_t rank;    // from 1, among the values that share them
  std::uint32_t largest; // bits of the largest value
  std::uint32_t blocks;  // that have counted in this pass
  std::uint32_t counts[binCount];
};

/// By one block: the bin that holds the rank, from a scan over the counts, which are then cleared.
__device__ void pickBin(RankState& state, std::uint32_t rank, int shift)
{
  __shared__ std::uint32_t sums[threads];
  constexpr int perThread = binCount / threads;
  std::uint32_t mine[perThread];
  std::uint32_t own = 0;
  for (int i = 0; i < perThread; ++i)
  {
    std::uint32_t& count = state.counts[threadIdx.x * perThread + i];
    mine[i] = atomicExch(&count, 0u); // as other blocks left it
    own += mine[i];
  }
  sums[threadIdx.x] = own;
  __syncthreads();
  for (int step = 1; step < threads; step *= 2)
  {
    const std::uint32_t before = int(threadIdx.x) >= step ? sums[threadIdx.x - step] : 0u;
    __syncthreads();
    sums[threadIdx.x] += before;
    __syncthreads();
  }
  std::uint32_t below = sums[threadIdx.x] - own;
  if (below < rank && rank <= below + own)
  {
    int i = 0;
    while (rank > below + mine[i])
    {
      below += mine[i++];
    }
    state.bits |= std::uint32_t(threadIdx.x * perThread + i) << shift;
    state.rank = rank - below;
  }
}

/// blockIdx.y is the image, `perImage` how many of its values count: of each line those from `first` on. The last pass
/// leaves the reference: the value of the rank where it is an amplitude at all, else the largest, else 1.
template<int pass>
__global__ void __launch_bounds__(threads)
  findRank(const float* envelope, const float* factor, int samples, int first, int lines, std::size_t perImage,
           std::uint32_t rank, RankState* states, double* reference)
{
  __shared__ std::uint32_t counts[binCount];
  __shared__ std::uint32_t largest;
  __shared__ bool last;
  constexpr int shift = passShift[pass];
  constexpr int bits = passBits[pass];
  RankState& state = states[blockIdx.y];
  for (int b = threadIdx.x; b < binCount; b += threads)
  {
    counts[b] = 0u;
  }
  largest = 0u;
  __syncthreads();
  const float* values = envelope + blockIdx.y * std::size_t(lines) * samples;
  const auto counted = std::uint32_t(samples - first);
  const std::uint32_t prefix = state.bits;
  std::uint32_t most = 0;
  for (std::size_t i = blockIdx.x * std::size_t(threads) + threadIdx.x; i < perImage;
       i += std::size_t(gridDim.x) * threads)
  {
    const std::uint32_t line = std::uint32_t(i) / counted;
    const std::uint32_t s = first + (std::uint32_t(i) - line * counted);
    const std::uint32_t v = gainedBits(values[std::size_t(line) * samples + s], factor[s]);
    most = max(most, v);
    if (pass == 0 || v >> (shift + bits) == prefix >> (shift + bits))
    {
      atomicAdd(counts + ((v >> shift) & ((1u << bits) - 1u)), 1u);
    }
  }
  atomicMax(&largest, most);
  __syncthreads();
  for (int b = threadIdx.x; b < binCount; b += threads)
  {
    if (counts[b])
    {
      atomicAdd(state.counts + b, counts[b]);
    }
  }
  __threadfence();
  __syncthreads();
  if (threadIdx.x == 0)
  {
    atomicMax(&state.largest, largest);
    __threadfence();
    last = atomicAdd(&state.blocks, 1u) == gridDim.x - 1;
  }
  __syncthreads();
  if (!last)
  {
    return;
  }
  pickBin(state, pass == 0 ? rank : state.rank, shift);
  __syncthreads();
  if (threadIdx.x == 0)
  {
    state.blocks = 0u;
    if (pass == passes - 1)
    {
      const float value = __uint_as_float(state.bits);
      const float top = __uint_as_float(atomicMax(&state.largest, 0u));
      reference[blockIdx.y] =
        value >= smallestNormalFloat ? whiteOverRank * double(value) : (top >= smallestNormalFloat ? double(top) : 1.0);
    }
  }
}

__global__ void setReference(double* reference, int images, double value)
{
  const int image = blockIdx.x * blockDim.x + threadIdx.x;
  if (image < images)
  {
    reference[image] = value;
  }
}

__global__ void mapLevels(const float* level, std::size_t count, const float* map, int mapCount, float* grey)
{
  const std::size_t i = blockIdx.x * std::size_t(blockDim.x) + threadIdx.x;
  if (i < count)
  {
    grey[i] = mapCount > 0 ? mapGrey(map, mapCount, level[i]) : level[i];
  }
}

/// `mapCount` 0: a linear grey map.
__global__ void compressSamples(const float* envelope, const double* gainDb, const float* lateralGainDb,
                                const double* reference, int samples, std::size_t perImage, float rangeDb,
                                float rejectDb, const float* map, int mapCount, float* grey)
{
  const std::size_t image = blockIdx.y;
  const double referenceDb = 20.0 * log10(reference[image]);
  for (std::size_t i = blockIdx.x * std::size_t(blockDim.x) + threadIdx.x; i < perImage;
       i += std::size_t(gridDim.x) * blockDim.x)
  {
    const std::size_t at = image * perImage + i;
    const float offsetDb = float(gainDb[i % samples] - referenceDb);
    const float level = compressedLevel(envelope[at], offsetDb + lateralGainDb[i / samples], rangeDb, rejectDb);
    grey[at] = mapCount > 0 ? mapGrey(map, mapCount, level) : level;
  }
}

/// What a thread's pixel is, with the place of its value; blockIdx.z is the image.
struct Pixel
{
  bool exists;
  bool inside;
  float line; // of a fan that is not steered
  float depthMm;
  float lateralMm;
  float fromCentreMm; // along the axis
  std::size_t at;
};

__device__ Pixel pixelOf(const PlaneScan& scan)
{
  const int i = blockIdx.y * blockDim.x + threadIdx.x;
  const int j = blockIdx.x * blockDim.y + threadIdx.y; // the longer axis of a grid, for any height
  if (i >= scan.width || j >= scan.height)
  {
    return {};
  }
  const float lateral = scan.lateralMm(i);
  const float x = scan.beams.axialFromCentre(scan.axialMm(j));
  float line;
  float depth;
  scan.beams.beamAt(lateral, x, line, depth);
  float unused;
  const bool inside =
    scan.area.contains(line, depth) && (scan.fanCount == 1 || scan.compound(nullptr, lateral, x, unused));
  return { true,
           inside,
           line,
           depth,
           lateral,
           x,
           (std::size_t(blockIdx.z) * scan.height + std::size_t(j)) * scan.width + std::size_t(i) };
}

__device__ float levelOf(const PlaneScan& scan, const float* grey, const Pixel& pixel)
{
  const float* values = grey + blockIdx.z * scan.valueCount();
  if (scan.fanCount == 1)
  {
    return scan.samples(values).at(pixel.line, pixel.depthMm * scan.samplesPerMm);
  }
  float level;
  scan.compound(values, pixel.lateralMm, pixel.fromCentreMm, level);
  return level;
}

__global__ void fillBytes(PlaneScan scan, const float* grey, std::uint8_t* bytes)
{
  const Pixel pixel = pixelOf(scan);
  if (pixel.exists)
  {
    bytes[pixel.at] = pixel.inside ? greyByte(levelOf(scan, grey, pixel)) : std::uint8_t(0);
  }
}

__global__ void fillLevels(PlaneScan scan, const float* grey, float* levels)
{
  const Pixel pixel = pixelOf(scan);
  if (pixel.exists)
  {
    levels[pixel.at] = pixel.inside ? levelOf(scan, grey, pixel) : 0.0f;
  }
}

__global__ void fillMask(PlaneScan scan, std::uint8_t* mask)
{
  const Pixel pixel = pixelOf(scan);
  if (pixel.exists)
  {
    mask[pixel.at] = pixel.inside ? 1 : 0;
  }
}

constexpr int blockWidth = 32;
constexpr int blockHeight = 8;

dim3 pixelGrid(const PlaneScan& scan, int images)
{
  return dim3((scan.height + blockHeight - 1) / blockHeight, (scan.width + blockWidth - 1) / blockWidth, images);
}

} // namespace

void DeviceDisplay::prepare(const BModeJob& job, cudaStream_t stream, Traffic& traffic)
{
  settings_ = job;
  settings_.gainFactor.clear();
  settings_.gainDb.clear();
  settings_.lateralGainDb.clear();
  settings_.haze.power.clear();
  factor_.upload(job.gainFactor, stream, traffic);
  gainDb_.upload(job.gainDb, stream, traffic);
  lateralGainDb_.upload(job.lateralGainDb, stream, traffic);
  greyMap_.upload(job.greyMap, stream, traffic);
  axialSmoothing_.upload(job.axialSmoothing, stream, traffic);
  lateralSmoothing_.upload(job.lateralSmoothing, stream, traffic);
  haze_.upload(job.haze.power, stream, traffic);
}

const float* DeviceDisplay::smooth(const float* values, std::size_t count, int samples, cudaStream_t stream)
{
  const auto blocks = unsigned((count + threads - 1) / threads);
  if (!settings_.axialSmoothing.empty())
  {
    smoothedAlong_.resize(count);
    smoothRows<<<blocks, threads, 0, stream>>>(values, smoothedAlong_.data(), count, samples, 1, axialSmoothing_.data(),
                                               int(settings_.axialSmoothing.size()) - 1);
    values = smoothedAlong_.data();
  }
  if (!settings_.lateralSmoothing.empty())
  {
    smoothedAcross_.resize(count);
    smoothRows<<<blocks, threads, 0, stream>>>(values, smoothedAcross_.data(), count, settings_.linesAcross, samples,
                                               lateralSmoothing_.data(), int(settings_.lateralSmoothing.size()) - 1);
    values = smoothedAcross_.data();
  }
  return values;
}

const float* DeviceDisplay::receive(const float* envelope, std::size_t count, int lines, int samples,
                                    cudaStream_t stream)
{
  const auto blocks = unsigned((count + threads - 1) / threads);
  const HazePower& haze = settings_.haze;
  if (settings_.noiseRms > 0.0f || haze.nodeCount > 0)
  {
    received_.resize(count);
    addNoiseAndHaze<<<blocks, threads, 0, stream>>>(
      envelope, received_.data(), count, lines, samples, settings_.noiseRms, settings_.noiseNodesPerSample,
      settings_.noiseSeed, haze_.data(), haze.nodeCount, haze.nodesPerSample);
    envelope = received_.data();
  }
  return settings_.smoothCompressed ? envelope : smooth(envelope, count, samples, stream);
}

GreyArrays DeviceDisplay::room(int images, int lines, int samples)
{
  GreyArrays arrays;
  arrays.lines = lines;
  arrays.samples = samples;
  arrays.reference.resize(std::size_t(images));
  arrays.grey.resize(std::size_t(lines) * samples * images);
  return arrays;
}

void DeviceDisplay::compress(const float* envelopes, int firstImage, int images, GreyArrays& to, cudaStream_t stream)
{
  const int lines = to.lines;
  const int samples = to.samples;
  const std::size_t perImage = std::size_t(lines) * samples;
  const std::size_t count = perImage * images;
  double* reference = to.reference.data() + firstImage;
  const int imageBlocks = (images + threads - 1) / threads;
  const float* envelope = receive(envelopes + firstImage * perImage, count, lines, samples, stream);
  if (settings_.automaticReference)
  {
    rank_.resize(sizeof(RankState) * std::size_t(images));
    rank_.clear(stream);
    auto* states = reinterpret_cast<RankState*>(rank_.data());
    const dim3 grid(unsigned(std::max<std::size_t>(1, std::min<std::size_t>(perImage / 2048, 528))), images);
    const int first = settings_.firstReferenceSample;
    const std::size_t counted = std::size_t(lines) * (samples - first);
    const auto rank = std::uint32_t(referenceRank(counted));
    for (const auto pass : { findRank<0>, findRank<1>, findRank<2> })
    {
      pass<<<grid, threads, 0, stream>>>(envelope, factor_.data(), samples, first, lines, counted, rank, states,
                                         reference);
    }
  }
  else
  {
    setReference<<<imageBlocks, threads, 0, stream>>>(reference, images, settings_.referenceAmplitude);
  }
  const dim3 grid(unsigned(std::max<std::size_t>(1, std::min<std::size_t>(perImage / 1024, 2048))), images);
  float* grey = to.grey.data() + firstImage * perImage;
  const int mapCount = int(settings_.greyMap.size());
  compressSamples<<<grid, threads, 0, stream>>>(envelope, gainDb_.data(), lateralGainDb_.data(), reference, samples,
                                                perImage, settings_.rangeDb, settings_.rejectDb, greyMap_.data(),
                                                settings_.smoothCompressed ? 0 : mapCount, grey);
  if (settings_.smoothCompressed)
  {
    const float* level = smooth(grey, count, samples, stream);
    mapLevels<<<unsigned((count + threads - 1) / threads), threads, 0, stream>>>(level, count, greyMap_.data(),
                                                                                 mapCount, grey);
  }
  check(cudaGetLastError(), "compressing grey levels");
}

DeviceArray<std::uint8_t> DeviceDisplay::convert(const PlaneScan& scan, const float* grey, int images,
                                                 cudaStream_t stream)
{
  DeviceArray<std::uint8_t> bytes;
  bytes.resize(std::size_t(scan.width) * scan.height * images);
  fillBytes<<<pixelGrid(scan, images), dim3(blockWidth, blockHeight), 0, stream>>>(scan, grey, bytes.data());
  check(cudaGetLastError(), "converting lines into an image");
  return bytes;
}

DeviceArray<float> DeviceDisplay::convertLevels(const PlaneScan& scan, const float* grey, int images,
                                                cudaStream_t stream)
{
  DeviceArray<float> levels;
  levels.resize(std::size_t(scan.width) * scan.height * images);
  fillLevels<<<pixelGrid(scan, images), dim3(blockWidth, blockHeight), 0, stream>>>(scan, grey, levels.data());
  check(cudaGetLastError(), "converting lines into an image");
  return levels;
}

DeviceArray<std::uint8_t> DeviceDisplay::maskOf(const PlaneScan& scan, cudaStream_t stream)
{
  DeviceArray<std::uint8_t> mask;
  mask.resize(std::size_t(scan.width) * scan.height);
  fillMask<<<pixelGrid(scan, 1), dim3(blockWidth, blockHeight), 0, stream>>>(scan, mask.data());
  check(cudaGetLastError(), "converting lines into an image");
  return mask;
}

} // namespace sono
