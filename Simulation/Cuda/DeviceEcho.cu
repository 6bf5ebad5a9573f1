#include "Cuda/DeviceEcho.cuh"

#include "Cuda/DevicePieces.cuh"
#include "Cuda/LineFinish.cuh"
#include "Cuda/NestedSplat.cuh"
#include "Cuda/RodRing.cuh"
#include "Cuda/SplatKernels.cuh"
#include "Cuda/SurfaceSplat.cuh"
#include "Cuda/WithKind.cuh"

#include <algorithm>
#include <cmath>

namespace sono {

DeviceEcho::DeviceEcho() = default;
DeviceEcho::~DeviceEcho() = default;

TracedOnDevice DeviceEcho::given(int first) const
{
  TracedOnDevice traced = given_;
  traced.intensity = given_.intensity ? given_.intensity + std::size_t(first) * given_.binCount : nullptr;
  traced.attenuation = given_.attenuation ? given_.attenuation + std::size_t(first) * given_.binCount : nullptr;
  traced.depthOffset = given_.depthOffset ? given_.depthOffset + std::size_t(first) * given_.binCount : nullptr;
  traced.reverberation = given_.reverberation ? given_.reverberation + std::size_t(first) * given_.binCount : nullptr;
  traced.reverberationNp =
    given_.reverberationNp ? given_.reverberationNp + std::size_t(first) * given_.binCount : nullptr;
  traced.echo = given_.echo ? given_.echo + std::size_t(first) * rangeCount_ : nullptr;
  return traced;
}

SplatLaunch DeviceEcho::splat(const Beam* beams, float scale, const Sight& sight) const
{
  return { beams,
           grid_,
           float(sampleMm_),
           sumCount_,
           scale,
           field_,
           sight.view,
           array_,
           arraySight_,
           sight.pieces.data(),
           1.0f / sigmas_.x,
           1.0f / sigmas_.y,
           sum_.data() };
}

void DeviceEcho::splatTissues(int first, int count, const TracedOnDevice& traced, cudaStream_t stream)
{
  TissueLaunch launch{};
  launch.splat = splat(sceneBeams_.data() + first, tissueScale_, tissueSight_);
  launch.voxels = voxels_.data();
  launch.detail = detail_.size() > 0 ? detail_.data() : nullptr;
  launch.size = size_;
  launch.perMm = 1.0f / spacing_;
  launch.extentMm = Vec3f(size_) * spacing_;
  launch.media = media_.data();
  launch.cellMm = cellMm_;
  launch.seed = seed_;
  launch.intensity = traced.intensity;
  launch.binCount = traced.binCount;
  launch.binMm = traced.binMm;
  withKind(kind_, [&](auto kind) {
    splatTissueCells<kind.value><<<dim3(count, chunks()), blockThreads, 0, stream>>>(launch);
  });
}

void DeviceEcho::splatNested(int first, int count, const TracedOnDevice& traced, cudaStream_t stream)
{
  NestedLaunch launch{};
  launch.splat = splat(sceneBeams_.data() + first, nestedScale_, {});
  launch.traced = traced;
  launch.sums = nestedSum_.data();
  launch.voxels = voxels_.data();
  launch.detail = detail_.size() > 0 ? detail_.data() : nullptr;
  launch.size = size_;
  launch.perMm = 1.0f / spacing_;
  launch.extentMm = Vec3f(size_) * spacing_;
  launch.media = nestedMedia_.data();
  launch.fibreScale = fibreScale_.data();
  launch.fibres = fibres_;
  launch.density = density_;
  launch.seed = seed_;
  int levels = 0;
  int halo = 0;
  for (std::size_t n = 0; n < nestedRanges_.size(); ++n)
  {
    const auto [fromMm, toMm] = nestedRanges_[n];
    if (fromMm < toMm)
    {
      const int level = density_.finest + int(n);
      launch.levels[levels++] = { nestedSights_[n].view, nestedSights_[n].pieces.data(), level, fromMm, toMm };
      halo = std::max(halo, nestedHaloSamples(kind_, level, grid_.samplesPerMm));
    }
  }
  if (levels == 0)
  {
    return;
  }
  const std::size_t bytes = 2 * std::size_t(chunkSamples + 2 * halo) * sizeof(int);
  withKind(kind_, [&](auto kind) {
    const auto kernel = splatNestedCells<kind.value>;
    if (bytes > sharedMemoryFor(kernel))
    {
      throw Error("the sampling is too fine for the GPU (" + std::to_string(1000.0 * sampleMm_) +
                  " um): lower the sampling frequency, or choose the CPU");
    }
    kernel<<<dim3(count, chunks(), levels), blockThreads, bytes, stream>>>(launch);
  });
}

void DeviceEcho::splatSurfaces(int first, int count, const TracedOnDevice& traced, cudaStream_t stream)
{
  const auto gridFor = [&](const SurfaceSet& set) {
    return dim3(count, std::clamp((set.groupCount + surfaceThreads - 1) / surfaceThreads, 1, surfaceSlices));
  };
  const auto launchFor = [&](const SurfaceSet& set, const Sight& sight, EchoSum* sums) {
    return SurfaceLaunch{ splat(sceneBeams_.data() + first, surfaceScale_, sight), traced, set, sums };
  };
  const auto splatTargets = [&](const Targets& targets, EchoSum* sums) {
    withKind(kind_, [&](auto kind) {
      splatSurfaceGroups<kind.value, SurfacePoint>
        <<<gridFor(targets.set), surfaceThreads, 0, stream>>>(launchFor(targets.set, targets.sight, sums));
    });
  };
  withKind(kind_, [&](auto kind) {
    splatSurfaceGroups<kind.value, SurfacePiece>
      <<<gridFor(pieceSet_), surfaceThreads, 0, stream>>>(launchFor(pieceSet_, pieceSight_, surfaceSum_.data()));
  });
  for (const Targets& targets : targets_)
  {
    const int taps = int(targets.taps.size());
    if (taps == 0)
    {
      splatTargets(targets, surfaceSum_.data());
      continue;
    }
    ringingSum_.resize(2 * std::size_t(count) * sumCount_);
    ringingSum_.clear(stream);
    splatTargets(targets, ringingSum_.data());
    addRungOf<<<dim3(count, (sumCount_ + rungThreads - 1) / rungThreads), rungThreads, 0, stream>>>(
      { ringingSum_.data(), surfaceSum_.data(), targets.taps.data(), taps, targets.stride, targets.lead, sumCount_ });
  }
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
  withKind(kind_, [&](auto kind) {
    splatPointBricks<kind.value><<<dim3(count, chunks()), blockThreads, 0, stream>>>(launch);
  });
}

void DeviceEcho::run(int first, int count, const TracedOnDevice& traced, bool wantsIq, cudaStream_t stream)
{
  const std::size_t lines = std::size_t(count);
  const bool sums = tissues_ || points_;
  sum_.resize(sums ? lines * sumCount_ : 0);
  nestedSum_.begin(nested_ ? 2 * lines * sumCount_ : 0, stream);
  surfaceSum_.begin(surfaces_ ? 2 * lines * sumCount_ : 0, stream);
  iq_.resize(wantsIq ? lines * sampleCount_ : 0);
  envelope_.resize(lines * sampleCount_);
  const bool sinks = downshift_ && traced.intensity && traced.attenuation;
  turns_.resize(sinks ? lines * rangeCount_ : 0);
  const FinishLaunch launch{ sums ? sum_.data() : nullptr,
                             nested_ ? nestedSum_.data() : nullptr,
                             1.0f / nestedScale_,
                             surfaces_ ? surfaceSum_.data() : nullptr,
                             1.0f / surfaceScale_,
                             traced,
                             level_.size() > 0 ? level_.data() : nullptr,
                             reverberationSpeckle_.data(),
                             linesPerImage_,
                             downshift_.value_or(Downshift{}),
                             sinks ? turns_.data() : nullptr,
                             carrier_.data(),
                             { float(std::cos(0.5 * carrierRadPerSample_)),
                               float(-std::sin(0.5 * carrierRadPerSample_)) },
                             pulse_.data(),
                             half_,
                             sumCount_,
                             rangeCount_,
                             sampleCount_,
                             float(sampleMm_),
                             float(carrierRadPerSample_),
                             double(float(sampleMm_)) / double(traced.binMm),
                             wantsIq ? iq_.data() : nullptr,
                             envelope_.data() };
  {
    // Each sums into memory of its own, and none fills the device alone.
    const Beside beside(stream);
    if (sinks)
    {
      sumTurns<<<count, turnThreads, 0, besideStream()>>>(launch, turns_.data());
    }
    if (nested_)
    {
      splatNested(first, count, traced, besideStream());
    }
    if (tissues_)
    {
      splatTissues(first, count, traced, stream);
    }
    if (points_)
    {
      splatPoints(first, count, stream);
    }
    if (surfaces_)
    {
      splatSurfaces(first, count, traced, stream);
    }
  }
  const std::size_t bytes = finishBytes(half_, complexPulse_);
  const auto kernel = complexPulse_ ? convolveLines<true> : convolveLines<false>;
  if (bytes > sharedMemoryFor(kernel))
  {
    throw Error("the pulse is too long for the GPU (" + std::to_string(2 * half_ + 1) +
                " samples): raise the bandwidth, lower the sampling frequency, or choose the CPU");
  }
  kernel<<<dim3(count, (sampleCount_ + tileSamples - 1) / tileSamples), finishThreads, bytes, stream>>>(launch);
  nestedSum_.end();
  surfaceSum_.end();
  check(cudaGetLastError(), "forming RF lines");
}

} // namespace sono
