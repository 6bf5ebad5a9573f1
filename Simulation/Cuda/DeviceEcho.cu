#include "Cuda/DeviceEcho.cuh"

#include "Cuda/LineFinish.cuh"
#include "Cuda/SplatChunk.cuh"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr int warpLanes = 32;
constexpr unsigned allLanes = 0xffffffffu;
constexpr int blockThreads = 128;
constexpr int brickCells = 4;          // cells along an edge of a brick of procedural scatterers (see TissueScatterers)
constexpr float darkIntensity = 1e-8f; // -160 dB

struct TissueLaunch
{
  SplatLaunch splat;
  const std::uint8_t* voxels;
  Vec3i size;
  Vec3f perMm;
  Vec3f extentMm;
  const ScatteringMedium* media; // 256
  float cellMm;
  std::uint64_t seed;
  const float* intensity; // or null
  int binCount;
  float binMm;
};

/// Whether any of the paths' intensity reaches a chunk; the last bin's holds below it.
__device__ bool isLit(const TissueLaunch& launch, const Chunk& chunk)
{
  if (!launch.intensity)
  {
    return true;
  }
  const float* bins = launch.intensity + std::size_t(chunk.line) * launch.binCount;
  const int firstBin = min(max(0, int(chunk.fromMm / launch.binMm) - 1), launch.binCount - 1);
  const int lastBin = min(int(chunk.toMm / launch.binMm) + 2, launch.binCount);
  bool lit = false;
  for (int b = firstBin + int(threadIdx.x); b < lastBin; b += blockDim.x)
  {
    lit |= bins[b] > darkIntensity;
  }
  return __syncthreads_or(lit);
}

__global__ void __launch_bounds__(blockThreads) splatTissueCells(TissueLaunch launch)
{
  __shared__ ShortSums sums;
  __shared__ ScatteringMedium media[256];
  const SplatLaunch& splat = launch.splat;
  const Chunk chunk = chunkOf(splat);
  for (int m = threadIdx.x; m < 256; m += blockThreads)
  {
    media[m] = launch.media[m];
  }
  sums.clear();
  const bool lit = isLit(launch, chunk);
  __syncthreads();
  const Beam beam = splat.beams[chunk.line];
  const auto splatCell = [&](const Vec3i& cell) {
    const Vec3i brick(cell.x >> 2, cell.y >> 2, cell.z >> 2);
    if (!splat.sightMeets(beam, (Vec3f(brick) + 0.5f) * (launch.cellMm * brickCells)))
    {
      return;
    }
    const ScattererSeed seed = scattererSeed(launch.seed, cell);
    const float x = (float(cell.x) + seed.fraction.x) * launch.cellMm;
    const float y = (float(cell.y) + seed.fraction.y) * launch.cellMm;
    const float z = (float(cell.z) + seed.fraction.z) * launch.cellMm;
    const BeamPlace place = placeInBeam(x, y, z, beam, splat.grid);
    const float weight = chunk.holds(place) ? splat.weight(place) : 0.0f;
    const Vec3i voxel(int(floorf(x * launch.perMm.x)), int(floorf(y * launch.perMm.y)),
                      int(floorf(z * launch.perMm.z)));
    if (weight == 0.0f || unsigned(voxel.x) >= unsigned(launch.size.x) ||
        unsigned(voxel.y) >= unsigned(launch.size.y) || unsigned(voxel.z) >= unsigned(launch.size.z))
    {
      return;
    }
    const std::size_t at =
      std::size_t(voxel.x) + std::size_t(launch.size.x) * (std::size_t(voxel.y) + std::size_t(launch.size.y) * voxel.z);
    const float amplitude = scattererAmplitude(media[launch.voxels[at]], seed.presence, seed.deviate);
    if (amplitude != 0.0f)
    {
      addScatterer(sums, splitScatterer(amplitude * weight, place.position, splat.grid), chunk.first, splat.scale);
    }
  };
  if (lit)
  {
    const CellRows rows(beam, { chunk.fromMm, chunk.toMm, splat.lateralMm, splat.elevationalMm }, launch.cellMm,
                        Vec3f(0.0f), launch.extentMm);
    const int rowCount = rows.rowCount();
    for (int first = int(threadIdx.x) / warpLanes * warpLanes; first < rowCount; first += blockThreads)
    {
      const int r = first + int(threadIdx.x) % warpLanes;
      const CellRows::Row row = r < rowCount ? rows.row(r) : CellRows::Row{ 0, 0, 0, 0 };
      forItemsOfWarp(row.count, [&](int owner, int place) {
        const int layer = __shfl_sync(allLanes, row.layer, owner);
        const int v = __shfl_sync(allLanes, row.v, owner);
        const int u = __shfl_sync(allLanes, row.first, owner) + place;
        if (owner >= 0)
        {
          splatCell(rows.cell(layer, v, u));
        }
      });
    }
    __syncthreads();
  }
  writeChunk(splat, chunk, sums, false);
}

struct PointLaunch
{
  SplatLaunch splat;
  const float* x;
  const float* y;
  const float* z;
  const float* amplitude;
  const int* begin;
  Vec3i firstBrick;
  Vec3i bricks;
  float edgeMm;
  bool add;
};

/// A point in front of its beam: what it echoes, at a position on the line.
struct SeenPoint
{
  float amplitude;
  float position;
};

struct PointRange
{
  int first;
  int count;
};

/// The points of a brick that the beam may see.
__device__ PointRange pointsOf(const PointLaunch& launch, const Beam& beam, const Vec3i& cell)
{
  const Vec3i brick = cell - launch.firstBrick;
  if (unsigned(brick.x) >= unsigned(launch.bricks.x) || unsigned(brick.y) >= unsigned(launch.bricks.y) ||
      unsigned(brick.z) >= unsigned(launch.bricks.z) ||
      !launch.splat.sightMeets(beam, (Vec3f(cell) + 0.5f) * launch.edgeMm))
  {
    return { 0, 0 };
  }
  const int b = brick.x + launch.bricks.x * (brick.y + launch.bricks.y * brick.z);
  return { launch.begin[b], launch.begin[b + 1] - launch.begin[b] };
}

__global__ void __launch_bounds__(blockThreads) splatPointBricks(PointLaunch launch)
{
  __shared__ LongSums sums;
  __shared__ WarpQueue<SeenPoint> queues[blockThreads / warpLanes];
  const SplatLaunch& splat = launch.splat;
  const Chunk chunk = chunkOf(splat);
  sums.clear();
  __syncthreads();
  const Beam beam = splat.beams[chunk.line];
  const Vec3f low = Vec3f(launch.firstBrick) * launch.edgeMm;
  const Vec3f high = Vec3f(launch.firstBrick + launch.bricks) * launch.edgeMm;
  const CellRows rows(beam, { chunk.fromMm, chunk.toMm, splat.lateralMm, splat.elevationalMm }, launch.edgeMm, low,
                      high);
  const auto splatPoint = [&](const SeenPoint& p) {
    addScatterer(sums, splitScatterer(p.amplitude, p.position, splat.grid), chunk.first, splat.scale);
  };
  const int lane = int(threadIdx.x) % warpLanes;
  const int warp = int(threadIdx.x) / warpLanes;
  const int rowCount = rows.rowCount();
  int queued = 0;
  // Rows of bricks are few: a warp takes a row, then brick by brick.
  for (int r = warp; r < rowCount; r += blockThreads / warpLanes)
  {
    const CellRows::Row row = rows.row(r);
    for (int n = 0; n < row.count; ++n)
    {
      const PointRange range = pointsOf(launch, beam, rows.cell(row.layer, row.v, row.first + n));
      for (int first = 0; first < range.count; first += warpLanes)
      {
        const int p = range.first + first + lane;
        SeenPoint point{ 0.0f, 0.0f };
        if (first + lane < range.count)
        {
          const BeamPlace at = placeInBeam(launch.x[p], launch.y[p], launch.z[p], beam, splat.grid);
          point = { chunk.holds(at) ? launch.amplitude[p] * splat.weight(at) : 0.0f, at.position };
        }
        queues[warp].push(point.amplitude != 0.0f, point, queued, splatPoint);
      }
    }
  }
  queues[warp].finish(queued, splatPoint);
  __syncthreads();
  writeChunk(splat, chunk, sums, launch.add);
}

float halfWidth(const BeamFieldAxis& axis)
{
  return std::max(-axis.lowMm, axis.highMm);
}

/// The unit of 64-bit sums: the largest single amplitude becomes 2^30, which leaves room for 2^32 of them.
float scaleFor(float largest)
{
  return largest > 0.0f ? std::ldexp(1.0f, 30 - std::ilogb(largest)) : 1.0f;
}

} // namespace

void DeviceEcho::Sight::upload(const std::optional<SightJob>& job, cudaStream_t stream, Traffic& traffic)
{
  some = job.has_value();
  if (some)
  {
    seen.upload(job->seen, stream, traffic);
    view = job->view;
    view.seen = seen.data();
    lateralMm = job->lateralMm;
    elevationalMm = job->elevationalMm;
  }
}

void DeviceEcho::setBeams(const std::vector<Beam>& beams)
{
  sigmas_ = Vec2f(beams.front().lateralSigmaMm, beams.front().elevationalSigmaMm);
}

/// Half axes of the ellipse around the axis that holds all that a beam sees: around a field's rectangle, or a
/// Gaussian's own.
Vec2f DeviceEcho::ellipse(const Sight& sight) const
{
  return sight.some ? Vec2f(1.4143f * sight.lateralMm, 1.4143f * sight.elevationalMm) : beamCutSigma * sigmas_;
}

void DeviceEcho::uploadCarrier(const EchoJob& job, cudaStream_t stream, Traffic& traffic)
{
  const double radPerSample = job.radPerMm * job.sampleMm;
  if (carrier_.size() == std::size_t(job.sumCount) && carrierRadPerSample_ == radPerSample)
  {
    return;
  }
  std::vector<float2> carrier;
  carrier.reserve(std::size_t(job.sumCount));
  for (int s = 0; s < job.sumCount; ++s)
  {
    const double phase = job.radPerMm * s * job.sampleMm;
    carrier.push_back({ float(std::cos(phase)), float(-std::sin(phase)) });
  }
  carrierRadPerSample_ = 0.0; // stays so when the upload fails
  carrier_.upload(carrier, stream, traffic);
  carrierRadPerSample_ = radPerSample;
}

void DeviceEcho::prepare(const EchoJob& job, cudaStream_t stream, Traffic& traffic)
{
  sampleCount_ = job.sampleCount;
  sumCount_ = job.sumCount;
  half_ = int(job.pulseRe.size() / 2);
  sampleMm_ = job.sampleMm;
  grid_ = makeLineGrid(float(job.sampleMm), job.radPerMm, job.sumCount);
  complexPulse_ = !job.pulseIm.empty();
  std::vector<float> pulse = job.pulseRe;
  pulse.insert(pulse.end(), job.pulseIm.begin(), job.pulseIm.end());
  pulse_.upload(pulse, stream, traffic);
  uploadCarrier(job, stream, traffic);
  level_.upload(job.boundaryLevel, stream, traffic);
  field_.reset();
  if (job.field)
  {
    if (fieldSource_ != job.field->values)
    {
      fieldSource_ = nullptr; // stays so when the upload fails
      fieldValues_.upload(*job.field->values, stream, traffic);
      fieldSource_ = job.field->values;
    }
    field_ = job.field->view;
    field_->values = fieldValues_.data();
  }

  tissues_ = job.tissues.has_value();
  if (tissues_)
  {
    const TissueJob& tissues = *job.tissues;
    if (sceneId_ != tissues.sceneId)
    {
      sceneId_ = 0; // stays so when the upload fails
      voxels_.upload(*tissues.voxels, stream, traffic);
      sceneId_ = tissues.sceneId;
    }
    sceneBeams_.upload(tissues.beams, stream, traffic);
    setBeams(tissues.beams);
    media_.upload(tissues.media.data(), tissues.media.size(), stream, traffic);
    tissueSight_.upload(tissues.sight, stream, traffic);
    size_ = tissues.size;
    spacing_ = tissues.spacing;
    cellMm_ = tissues.cellMm;
    seed_ = tissues.seed;
    float largest = 0.0f;
    for (const ScatteringMedium& m : tissues.media)
    {
      largest = std::max(largest, std::fabs(m.mean) + 6.0f * std::fabs(m.sigma)); // no deviate is beyond 5.5
    }
    // Amplitudes that come together in a sample, on average, and a wide margin; 32 bits hold them with 24 to spare for
    // their fractions.
    const double areaMm2 = field_ ? 4.0 * halfWidth(field_->lateral) * halfWidth(field_->elevational)
                                  : 6.3 * double(sigmas_.x) * double(sigmas_.y);
    const double together = 64.0 + 16.0 * areaMm2 * sampleMm_ / std::pow(double(cellMm_), 3);
    tissueScale_ = largest > 0.0f ? float(2147483647.0 / (together * largest)) : 1.0f;
  }

  points_ = job.points.has_value();
  if (points_)
  {
    const PointJob& points = *job.points;
    if (table_ != points.table)
    {
      table_ = nullptr;
      x_.upload(points.table->x, stream, traffic);
      y_.upload(points.table->y, stream, traffic);
      z_.upload(points.table->z, stream, traffic);
      amplitude_.upload(points.table->amplitude, stream, traffic);
      begin_.upload(points.table->begin, stream, traffic);
      float largest = 0.0f;
      for (const float a : points.table->amplitude)
      {
        largest = std::max(largest, std::fabs(a));
      }
      pointScale_ = scaleFor(largest);
      table_ = points.table;
    }
    pointBeams_.upload(points.beams, stream, traffic);
    setBeams(points.beams);
    pointSight_.upload(points.sight, stream, traffic);
  }

  given_ = {};
  if (job.given)
  {
    givenIntensity_.upload(job.given->intensity, stream, traffic);
    given_.intensity = givenIntensity_.data();
    given_.binCount = job.given->binCount;
    given_.binMm = job.given->binMm;
    if (!job.given->boundaryEcho.empty())
    {
      givenEcho_.upload(reinterpret_cast<const float2*>(job.given->boundaryEcho.data()), job.given->boundaryEcho.size(),
                        stream, traffic);
      given_.echo = givenEcho_.data();
    }
  }
}

TracedOnDevice DeviceEcho::given(int first) const
{
  TracedOnDevice traced = given_;
  traced.intensity = given_.intensity ? given_.intensity + std::size_t(first) * given_.binCount : nullptr;
  traced.echo = given_.echo ? given_.echo + std::size_t(first) * sumCount_ : nullptr;
  return traced;
}

SplatLaunch DeviceEcho::splat(const Beam* beams, float scale, const Sight& sight) const
{
  const Vec2f halfAxes = ellipse(sight);
  return { beams,
           grid_,
           float(sampleMm_),
           sumCount_,
           scale,
           field_.has_value(),
           field_.value_or(BeamFieldView{}),
           sight.some,
           sight.view,
           halfAxes.x,
           halfAxes.y,
           1.0f / sigmas_.x,
           1.0f / sigmas_.y,
           sum_.data() };
}

void DeviceEcho::splatTissues(int first, int count, const TracedOnDevice& traced, cudaStream_t stream)
{
  TissueLaunch launch{};
  launch.splat = splat(sceneBeams_.data() + first, tissueScale_, tissueSight_);
  launch.voxels = voxels_.data();
  launch.size = size_;
  launch.perMm = 1.0f / spacing_;
  launch.extentMm = Vec3f(size_) * spacing_;
  launch.media = media_.data();
  launch.cellMm = cellMm_;
  launch.seed = seed_;
  launch.intensity = traced.intensity;
  launch.binCount = traced.binCount;
  launch.binMm = traced.binMm;
  splatTissueCells<<<dim3(count, chunks()), blockThreads, 0, stream>>>(launch);
}

void DeviceEcho::splatPoints(int first, int count, cudaStream_t stream)
{
  PointLaunch launch{};
  launch.splat = splat(pointBeams_.data() + first, pointScale_, pointSight_);
  launch.x = x_.data();
  launch.y = y_.data();
  launch.z = z_.data();
  launch.amplitude = amplitude_.data();
  launch.begin = begin_.data();
  launch.firstBrick = table_->firstBrick;
  launch.bricks = table_->bricks;
  launch.edgeMm = table_->edgeMm;
  launch.add = tissues_;
  splatPointBricks<<<dim3(count, chunks()), blockThreads, 0, stream>>>(launch);
}

void DeviceEcho::run(int first, int count, const TracedOnDevice& traced, bool wantsIq, cudaStream_t stream)
{
  const std::size_t lines = std::size_t(count);
  sum_.resize(lines * sumCount_);
  iq_.resize(wantsIq ? lines * sampleCount_ : 0);
  envelope_.resize(lines * sampleCount_);
  if (tissues_)
  {
    splatTissues(first, count, traced, stream);
  }
  if (points_)
  {
    splatPoints(first, count, stream);
  }
  const FinishLaunch launch{ tissues_ || points_ ? sum_.data() : nullptr,
                             traced,
                             level_.size() > 0 ? level_.data() : nullptr,
                             carrier_.data(),
                             pulse_.data(),
                             half_,
                             sumCount_,
                             sampleCount_,
                             float(sampleMm_),
                             wantsIq ? iq_.data() : nullptr,
                             envelope_.data() };
  const int width = tileSamples + 2 * half_;
  const std::size_t bytes = (2 * std::size_t(width + width / 32 + 2) + pulse_.size()) * sizeof(float);
  const auto kernel = complexPulse_ ? convolveLines<true> : convolveLines<false>;
  if (bytes > sharedMemoryFor(kernel))
  {
    throw Error("the pulse is too long for the GPU (" + std::to_string(2 * half_ + 1) +
                " samples): raise the bandwidth, lower the sampling frequency, or choose the CPU");
  }
  check(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, int(bytes)),
        "preparing to convolve a pulse of that length");
  kernel<<<dim3(count, (sampleCount_ + tileSamples - 1) / tileSamples), finishThreads, bytes, stream>>>(launch);
  check(cudaGetLastError(), "forming RF lines");
}

} // namespace sono
