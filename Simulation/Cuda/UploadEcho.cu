#include "Cuda/DeviceEcho.cuh"

#include "Cuda/DevicePieces.cuh"
#include "Cuda/SplatKernels.cuh"
#include "Kernel/DetailCode.h"

#include <algorithm>
#include <cmath>

// What a job brings to the device: only what is not there already.

namespace sono {

namespace {

/// A line's samples of noise, times their rms.
__global__ void drawSamples(ReverberationNoise noise, const float* rms, int samples, float2* speckle)
{
  const int s = int(blockIdx.x * blockDim.x + threadIdx.x);
  if (s < samples)
  {
    const Vec2f value = rms[s] * noise.at(int(blockIdx.y), s);
    speckle[std::size_t(blockIdx.y) * std::size_t(samples) + std::size_t(s)] = { value.x, value.y };
  }
}

/// Samples of a line, nothing above the first, convolved with the pulse: re, and im where it is complex, from its end
/// to its start.
__global__ void convolveSamples(const float2* speckle, int samples, const float* pulse, int half, bool complexPulse,
                                int heardSamples, float2* heard)
{
  const int s = int(blockIdx.x * blockDim.x + threadIdx.x);
  if (s >= heardSamples)
  {
    return;
  }
  const float2* of = speckle + std::size_t(blockIdx.y) * std::size_t(samples);
  const int taps = 2 * half + 1;
  float2 sum{ 0.0f, 0.0f };
  for (int k = max(0, half - s); k < taps; ++k)
  {
    const float2 v = of[s + k - half];
    const float re = pulse[k];
    const float im = complexPulse ? pulse[taps + k] : 0.0f;
    sum = { sum.x + re * v.x - im * v.y, sum.y + re * v.y + im * v.x };
  }
  heard[std::size_t(blockIdx.y) * std::size_t(heardSamples) + std::size_t(s)] = sum;
}

/// An ellipse around a rectangle is so much larger.
constexpr float aroundRectangle = 1.4143f;

/// Sets what an array's beam sees of a chunk whose echoes come from ranges between the piece's two depths: whole bricks
/// (their diagonal is `brickMm` long), and depths that are less than the range to the side. Lines are up to `widening`
/// times wider than straight ahead.
void widenByRange(const BeamReachTable& reach, float brickMm, const Vec2f& widening, BeamPiece& piece)
{
  const int last = reach.steps() - 1;
  const int to = std::clamp(int((piece.toMm + brickMm) / reach.stepMm()), 0, last);
  const float firstMm = piece.fromMm;
  Vec2f widest(0.0f);
  for (int n = to; n >= 0; --n)
  {
    const Vec2f seen = reach.step(n) + brickMm;
    // What a brick in this step shows may lie a brick deeper.
    const float deepestMm = n == last ? piece.toMm : float(n + 1) * reach.stepMm() + brickMm;
    if (glm::length(Vec3f(seen * widening, deepestMm)) >= firstMm)
    {
      widest = glm::max(widest, seen);
      piece.fromMm = std::min(piece.fromMm, float(n) * reach.stepMm() - brickMm);
    }
  }
  piece.lateralMm = aroundRectangle * widest.x;
  piece.elevationalMm = aroundRectangle * widest.y;
}

/// The unit of 64-bit sums: the largest single amplitude becomes 2^30, which leaves room for 2^32 of them.
float scaleFor(float largest)
{
  return largest > 0.0f ? std::ldexp(1.0f, 30 - std::ilogb(largest)) : 1.0f;
}

} // namespace

/// The table of the beam's kind, kept on the device while it is the same.
void DeviceEcho::uploadBeam(const BeamJob& job, cudaStream_t stream, Traffic& traffic)
{
  kind_ = job.kind;
  reach_ = job.reach;
  if (job.field)
  {
    if (fieldSource_ != job.field->values)
    {
      fieldSource_ = nullptr; // stays so when the upload fails
      fieldValues_.upload(*job.field->values, stream, traffic);
      fieldSource_ = job.field->values;
    }
    field_ = job.field->view;
    field_.values = fieldValues_.data();
  }
  if (job.array)
  {
    const ArraySight& sight = job.array->sight();
    if (arraySource_ != job.array)
    {
      arraySource_ = nullptr;
      arrayLateral_.upload(job.array->lateral(), stream, traffic);
      arrayElevational_.upload(job.array->elevational(), stream, traffic);
      sightLateral_.upload(sight.lateral(), stream, traffic);
      sightElevational_.upload(sight.elevational(), stream, traffic);
      arraySource_ = job.array;
    }
    array_ = job.array->view(arrayLateral_.data(), arrayElevational_.data());
    arraySight_ = sight.view(sightLateral_.data(), sightElevational_.data());
  }
}

void DeviceEcho::uploadFieldSight(const std::optional<SightJob>& job, Sight& sight, cudaStream_t stream,
                                  Traffic& traffic)
{
  if (job)
  {
    sight.seen.upload(job->seen, stream, traffic);
    sight.view = job->view;
    sight.view.seen = sight.seen.data();
  }
}

/// Of each chunk the ellipse around the axis that holds all that a beam straight ahead sees.
void DeviceEcho::uploadSight(const std::optional<SightJob>& job, const std::vector<Beam>& beams, float brickMm,
                             Sight& sight, cudaStream_t stream, Traffic& traffic)
{
  sigmas_ = Vec2f(beams.front().lateralSigmaMm, beams.front().elevationalSigmaMm);
  uploadFieldSight(job, sight, stream, traffic);
  Vec2f widening(1.0f);
  for (const Beam& beam : beams)
  {
    widening = kind_ == BeamKind::Array ? glm::max(widening, 1.0f / Vec2f(beam.lateralCosine, beam.elevationalCosine))
                                        : widening;
  }
  std::vector<BeamPiece> pieces;
  for (int c = 0; c < chunks(); ++c)
  {
    const int last = std::min((c + 1) * chunkSamples, sumCount_);
    BeamPiece piece{ float((c * chunkSamples - 1) * sampleMm_), float(last * sampleMm_), 0.0f, 0.0f };
    Vec2f halfAxes = beamCutSigma * sigmas_;
    if (job)
    {
      halfAxes = aroundRectangle * Vec2f(job->lateralMm, job->elevationalMm);
    }
    else if (reach_)
    {
      halfAxes = reach_->widest(piece.fromMm, piece.toMm);
    }
    piece.lateralMm = halfAxes.x;
    piece.elevationalMm = halfAxes.y;
    if (kind_ == BeamKind::Array)
    {
      widenByRange(*reach_, std::sqrt(3.0f) * brickMm, widening, piece);
    }
    pieces.push_back(piece);
  }
  sight.pieces.upload(pieces, stream, traffic);
}

void DeviceEcho::uploadVoxels(const VoxelJob& job, cudaStream_t stream, Traffic& traffic)
{
  if (sceneId_ != job.sceneId)
  {
    sceneId_ = 0; // stays so when the upload fails
    voxels_.upload(*job.tissues, stream, traffic);
    detail_.upload(*job.detail, stream, traffic);
    sceneId_ = job.sceneId;
  }
  size_ = job.size;
  spacing_ = job.spacing;
}

void DeviceEcho::uploadNested(const EchoJob& echo, cudaStream_t stream, Traffic& traffic)
{
  const NestedJob& job = *echo.nested;
  uploadVoxels(job.voxels, stream, traffic);
  if (job.fibres && fibresSceneId_ != job.voxels.sceneId)
  {
    fibresSceneId_ = 0; // stays so when the upload fails
    fibreWords_.upload(job.fibres->packed(), stream, traffic);
    fibresSceneId_ = job.voxels.sceneId;
  }
  fibres_ = job.fibres ? job.fibres->view() : FibreView{};
  fibres_.packed = job.fibres ? fibreWords_.data() : nullptr;
  nestedMedia_.upload(job.media.data(), job.media.size(), stream, traffic);
  fibreScale_.upload(job.fibreScale.data(), job.fibreScale.size(), stream, traffic);
  perMm3_.upload(job.perMm3, stream, traffic);
  coarseEnough_.upload(job.coarseEnough, stream, traffic);
  density_ = job.density;
  density_.perMm3 = perMm3_.data();
  density_.coarseEnough = coarseEnough_.data();
  nestedRanges_ = job.ranges;
  nestedSights_.resize(job.ranges.size());
  for (std::size_t n = 0; n < job.ranges.size(); ++n)
  {
    const auto sight = job.sights.empty() ? std::nullopt : std::optional<SightJob>(job.sights[n]);
    const float brickMm = nestedCellMm(density_.finest + int(n)) * float(nestedBrickCells);
    uploadSight(sight, echo.sceneBeams, brickMm, nestedSights_[n], stream, traffic);
  }
  seed_ = job.seed;
  float largest = 0.0f;
  for (const NestedMedium& m : job.media)
  {
    largest = std::max(largest, m.amplitude);
  }
  // A few come together in a sample, with random signs: 32 bits hold 256 of the largest.
  largest *= (job.voxels.detail->empty() ? 1.0f : largestDetailFactor) *
             nestedShareOf(0.125f, nestedCellMm(density_.coarsest)).scale *
             std::max(1.0f, float(echo.beam.largestWeight));
  nestedScale_ = largest > 0.0f ? 2147483647.0f / (256.0f * largest) : 1.0f;
}

namespace {

/// Adds the points of a brick as groups.
void addGroups(const std::vector<SurfacePoint>& points, const TargetPointJob::Brick& brick,
               std::vector<SurfaceGroup>& groups)
{
  for (int first = brick.first; first < brick.end; first += warpLanes)
  {
    const int end = std::min(brick.end, first + warpLanes);
    Vec3f low(1e30f);
    Vec3f high(-1e30f);
    for (int n = first; n < end; ++n)
    {
      low = glm::min(low, points[std::size_t(n)].position);
      high = glm::max(high, points[std::size_t(n)].position);
    }
    groups.push_back({ brick.centreMm, 0.5f * (low + high), 0.5f * glm::length(high - low), first, end - first });
  }
}

} // namespace

void DeviceEcho::uploadSurfaces(const EchoJob& echo, cudaStream_t stream, Traffic& traffic)
{
  const SurfaceJob& job = *echo.surfaces;
  uploadVoxels(job.voxels, stream, traffic);
  surfaceRows_.upload(job.rows, stream, traffic);
  diffuseL_.upload(job.diffuseL, stream, traffic);
  diffuseE_.upload(job.diffuseE, stream, traffic);
  const auto withTables = [&](SurfaceTable table) {
    table.rows = surfaceRows_.data();
    table.diffuseL = diffuseL_.data();
    table.diffuseE = diffuseE_.data();
    return table;
  };
  pieceSet_.table = withTables(job.pieceTable);
  pieceSet_.longestStepMm = job.longestStepMm;
  pieceSet_.media = job.media;
  pieceSet_.nets = job.nets;
  pieceSet_.edgeMm = job.pieces->edgeMm();
  pieceSet_.marginMm = 1.5f * job.longestStepMm;
  pieceSet_.seed = job.seed;
  uploadFieldSight(job.sight, pieceSight_, stream, traffic);
  targets_.resize(job.targets.size());
  for (std::size_t t = 0; t < targets_.size(); ++t)
  {
    const TargetPointJob& given = job.targets[t];
    Targets& targets = targets_[t];
    std::vector<SurfaceGroup> groups;
    for (const TargetPointJob::Brick& brick : given.bricks)
    {
      addGroups(given.points, brick, groups);
    }
    targets.points.upload(given.points, stream, traffic);
    targets.groups.upload(groups, stream, traffic);
    targets.taps.upload(given.ring.taps, stream, traffic);
    targets.stride = given.ring.stride;
    targets.lead = given.ring.lead;
    targets.set = pieceSet_;
    targets.set.table = withTables(job.targetTable);
    targets.set.groups = targets.groups.data();
    targets.set.groupCount = int(groups.size());
    targets.set.points = targets.points.data();
    targets.set.edgeMm = given.edgeMm;
    targets.set.marginMm = 0.0f;
    uploadFieldSight(given.sight, targets.sight, stream, traffic);
  }
  // A perfect mirror across the whole beam echoes 1; a point of it far less.
  surfaceScale_ = 536870912.0f / std::max(1.0f, float(echo.beam.largestWeight));
}

void DeviceEcho::findPieces(const EchoJob& echo, cudaEvent_t uploaded, Traffic& traffic)
{
  if (!surfaces_)
  {
    return;
  }
  const SurfaceJob& job = *echo.surfaces;
  const std::shared_ptr<DevicePieces> pieces = DevicePieces::of(*job.pieces);
  heardPieces_ =
    pieces->heardBy(job, voxels_.data(),
                    { splat(sceneBeams_.data(), 1.0f, pieceSight_), echo.lineCount, kind_, pieceSet_.table, job.media },
                    uploaded, traffic);
  pieces_ = pieces; // what was there before is no longer read: all that reads it was asked for before the event
  pieceSet_.groups = heardPieces_->groups.data();
  pieceSet_.groupCount = int(heardPieces_->groups.size());
  pieceSet_.pieces = heardPieces_->pieces.data();
}

/// The speckle that reverberates belongs to the probe and is the same for every image.
void DeviceEcho::drawSpeckle(const EchoJob& job, cudaStream_t stream, Traffic& traffic)
{
  if (linesPerImage_ == job.linesPerImage && noise_ == job.noise && reverberationRms_ == job.reverberationRms &&
      pulseRe_ == job.pulseRe && pulseIm_ == job.pulseIm)
  {
    return;
  }
  linesPerImage_ = 0; // stays so when the upload fails
  DeviceArray<float> rms;
  rms.upload(job.reverberationRms, stream, traffic);
  const std::size_t samples = job.reverberationRms.size();
  DeviceArray<float2> drawn;
  drawn.resize(std::size_t(job.linesPerImage) * samples);
  reverberationSpeckle_.resize(samples > 0 ? std::size_t(job.linesPerImage) * std::size_t(job.sampleCount) : 0);
  if (samples > 0)
  {
    constexpr int threads = 128;
    const auto grid = [&](std::size_t count) {
      return dim3(unsigned((count + threads - 1) / threads), unsigned(job.linesPerImage));
    };
    drawSamples<<<grid(samples), threads, 0, stream>>>(job.noise, rms.data(), int(samples), drawn.data());
    convolveSamples<<<grid(std::size_t(job.sampleCount)), threads, 0, stream>>>(
      drawn.data(), int(samples), pulse_.data(), half_, complexPulse_, job.sampleCount, reverberationSpeckle_.data());
    check(cudaGetLastError(), "drawing speckle");
    check(await(stream), "drawing speckle");
  }
  linesPerImage_ = job.linesPerImage;
  noise_ = job.noise;
  reverberationRms_ = job.reverberationRms;
  pulseRe_ = job.pulseRe;
  pulseIm_ = job.pulseIm;
}

void DeviceEcho::uploadCarrier(const EchoJob& job, cudaStream_t stream, Traffic& traffic)
{
  const double radPerSample = job.radPerMm * job.sampleMm;
  if (carrier_.size() == std::size_t(job.rangeCount) && carrierRadPerSample_ == radPerSample)
  {
    return;
  }
  std::vector<float2> carrier;
  carrier.reserve(std::size_t(job.rangeCount));
  for (int s = 0; s < job.rangeCount; ++s)
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
  rangeCount_ = job.rangeCount;
  half_ = int(job.pulseRe.size() / 2);
  sampleMm_ = job.sampleMm;
  grid_ = makeLineGrid(float(job.sampleMm), job.radPerMm, job.sumCount);
  complexPulse_ = !job.pulseIm.empty();
  std::vector<float> pulse = job.pulseRe;
  pulse.insert(pulse.end(), job.pulseIm.begin(), job.pulseIm.end());
  pulse_.upload(pulse, stream, traffic);
  uploadCarrier(job, stream, traffic);
  level_.upload(job.boundaryLevel, stream, traffic);
  drawSpeckle(job, stream, traffic);
  downshift_ = job.downshift;
  uploadBeam(job.beam, stream, traffic);
  sceneBeams_.upload(job.sceneBeams, stream, traffic);

  tissues_ = job.tissues.has_value();
  if (tissues_)
  {
    const TissueJob& tissues = *job.tissues;
    uploadVoxels(tissues.voxels, stream, traffic);
    media_.upload(tissues.media.data(), tissues.media.size(), stream, traffic);
    uploadSight(tissues.sight, job.sceneBeams, tissues.cellMm * brickCells, tissueSight_, stream, traffic);
    cellMm_ = tissues.cellMm;
    seed_ = tissues.seed;
    float largest = 0.0f;
    for (const ScatteringMedium& m : tissues.media)
    {
      largest = std::max(largest, std::fabs(m.mean) + 6.0f * std::fabs(m.sigma)); // no deviate is beyond 5.5
    }
    largest *= tissues.voxels.detail->empty() ? 1.0f : largestDetailFactor;
    // Amplitudes that come together in a sample, on average, and a wide margin; 32 bits hold them with 24 to spare for
    // their fractions.
    const double together =
      64.0 * job.beam.largestWeight + 16.0 * job.beam.largestAreaMm2 * sampleMm_ / std::pow(double(cellMm_), 3);
    tissueScale_ = largest > 0.0f ? float(2147483647.0 / (together * largest)) : 1.0f;
  }

  nested_ = job.nested.has_value();
  if (nested_)
  {
    uploadNested(job, stream, traffic);
  }
  surfaces_ = job.surfaces.has_value();
  if (surfaces_)
  {
    uploadSurfaces(job, stream, traffic);
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
      table_ = points.table;
    }
    pointBeams_.upload(points.beams, stream, traffic);
    uploadSight(points.sight, points.beams, table_->edgeMm, pointSight_, stream, traffic);
    pointScale_ = scaleFor(table_->loudest * std::max(1.0f, float(job.beam.largestWeight)));
  }

  given_ = {};
  if (job.given)
  {
    givenIntensity_.upload(job.given->intensity, stream, traffic);
    given_.intensity = givenIntensity_.data();
    if (!job.given->attenuationNpPerMHz.empty())
    {
      givenAttenuation_.upload(job.given->attenuationNpPerMHz, stream, traffic);
      given_.attenuation = givenAttenuation_.data();
    }
    if (!job.given->depthOffsetMm.empty())
    {
      givenDepthOffset_.upload(job.given->depthOffsetMm, stream, traffic);
      given_.depthOffset = givenDepthOffset_.data();
    }
    if (!job.given->reverberation.empty())
    {
      givenReverberation_.upload(job.given->reverberation, stream, traffic);
      given_.reverberation = givenReverberation_.data();
      givenReverberationNp_.upload(job.given->reverberationNpPerMHz, stream, traffic);
      given_.reverberationNp = givenReverberationNp_.data();
    }
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

} // namespace sono
