#include "Cuda/DeviceChannels.h"

#include "Core/Progress.h"
#include "Cuda/ChannelKernels.cuh"
#include "Cuda/DeviceImager.h"
#include "Cuda/DeviceMemory.cuh"

#include <algorithm>

namespace sono {
namespace {

constexpr double mostAsked = 3e10; ///< points times sums, some tenths of a second

/// What stays on the device for all shells.
struct OnDevice
{
  DeviceArray<double> delays;
  DeviceArray<float> weights, turnCosine, turnSine, rf;
  DeviceArray<float2> pulse;
  DeviceArray<float> pieceX, pieceZ, pieceNormalX, pieceNormalZ;
  DeviceArray<float> x, y, z, re, im, lagMm, sinkNp, rise;
  DeviceArray<float> drive, parts, sums;
};

int largestShell(const ChannelShells& shells)
{
  std::size_t points = 0;
  for (const ChannelShell& shell : shells.shells)
  {
    points = std::max(points, shell.end - shell.first);
  }
  return int(points);
}

} // namespace

ChannelData formChannelsOnDevice(const ChannelPlan& plan, const ChannelPoints& points, const Progress& progress)
{
  if (!cudaStatus().usable)
  {
    throw Error("the GPU cannot be used: " + cudaStatus().what + "; choose the CPU");
  }
  // A lane of its own, so that nobody else's work is waited for; it lives as long as the process.
  static DeviceLane* const lane = openLane(cudaStatus().devices.front(), Waiting::Asleep);
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  const OnLane onLane(lane);
  const cudaStream_t stream = deviceStream();
  ChannelData data = plan.empty();
  const ChannelShells shells = makeShells(plan, points);
  if (shells.bins == 0 || shells.shells.empty())
  {
    return data;
  }
  Traffic traffic;
  OnDevice on;
  const ElementPieces& pieces = plan.pieces;
  on.pieceX.upload(pieces.x, stream, traffic);
  on.pieceZ.upload(pieces.z, stream, traffic);
  on.pieceNormalX.upload(pieces.normalX, stream, traffic);
  on.pieceNormalZ.upload(pieces.normalZ, stream, traffic);
  on.x.upload(shells.points.x, stream, traffic);
  on.y.upload(shells.points.y, stream, traffic);
  on.z.upload(shells.points.z, stream, traffic);
  on.re.upload(shells.points.re, stream, traffic);
  on.im.upload(shells.points.im, stream, traffic);
  on.lagMm.upload(shells.points.lagMm, stream, traffic);
  on.sinkNp.upload(shells.points.sinkNp, stream, traffic);
  on.rise.upload(shells.points.rise, stream, traffic);
  on.delays.upload(plan.transmits.delaysUs, stream, traffic);
  on.weights.upload(plan.transmits.weights, stream, traffic);
  on.turnCosine.upload(shells.turnCosine, stream, traffic);
  on.turnSine.upload(shells.turnSine, stream, traffic);
  on.pulse.upload(reinterpret_cast<const float2*>(shells.pulse.data()), shells.pulse.size(), stream, traffic);
  on.rf.resize(data.rf.size());
  on.rf.clear(stream);
  ShellJob job{};
  job.pieceX = on.pieceX.data();
  job.pieceZ = on.pieceZ.data();
  job.pieceNormalX = on.pieceNormalX.data();
  job.pieceNormalZ = on.pieceNormalZ.data();
  job.elements = pieces.elements;
  job.padded = pieces.padded;
  job.perElement = pieces.perElement;
  job.halfWidthMm = pieces.halfWidthMm;
  job.isSoft = plan.settings.baffle == Baffle::Soft;
  job.isFlat = plan.settings.flat;
  job.shortestMm = plan.shortestMm;
  job.npPerMmMHz = plan.npPerMmMHz;
  job.shape = plan.shape;
  job.stepMHz = shells.stepMHz;
  job.firstBin = shells.firstBin;
  job.centreMHz = float(plan.centreMHz);
  job.transmits = int(plan.transmits.each.size());
  job.points = { on.x.data(),  on.y.data(),     on.z.data(),      on.re.data(),
                 on.im.data(), on.lagMm.data(), on.sinkNp.data(), on.rise.data() };
  const std::size_t bytes = std::size_t(tilePoints) * std::size_t(pieces.padded) * sizeof(float2);
  if (bytes > sharedMemoryFor(sumShellKernel))
  {
    throw Error("elementCount is " + std::to_string(pieces.elements) +
                ": the GPU's blocks do not hold so many; use fewer elements or choose the CPU");
  }
  const int transmitTiles = (job.transmits + tileTransmits - 1) / tileTransmits;
  const int elementTiles = (pieces.padded + tileElements - 1) / tileElements;
  // A few thousand blocks keep a large GPU busy.
  const int blocks = shells.bins * transmitTiles * elementTiles;
  const int tiles = (largestShell(shells) + tilePoints - 1) / tilePoints;
  job.parts = std::clamp(4096 / blocks, 1, std::min(16, tiles));
  const std::size_t values = std::size_t(shells.bins) * std::size_t(job.transmits) * 2 * std::size_t(pieces.padded);
  on.drive.resize(values);
  on.parts.resize(values * std::size_t(job.parts));
  on.sums.resize(values);
  driveKernel<<<unsigned((values / 2 + threads - 1) / threads), threads, 0, stream>>>(
    on.delays.data(), on.weights.data(), shells.stepMHz, shells.firstBin, shells.bins, job.transmits, job.elements,
    job.padded, on.drive.data());
  check(cudaGetLastError(), "delaying transmits");
  job.drive = on.drive.data();
  SynthesisJob synthesis{ shells.bins,     shells.firstBin,      shells.samples,    0,
                          job.transmits,   job.elements,         job.padded,        plan.sampleCount,
                          on.pulse.data(), on.turnCosine.data(), on.turnSine.data() };
  const dim3 synthesisGrid(unsigned((shells.samples + synthSamples - 1) / synthSamples),
                           unsigned((job.transmits * job.elements + synthSignals - 1) / synthSignals));
  double asked = 0.0; // since the device was waited for
  for (const ChannelShell& shell : shells.shells)
  {
    report(progress, double(shell.first) / double(shells.points.size()));
    job.firstPoint = int(shell.first);
    job.endPoint = int(shell.end);
    const dim3 grid(unsigned(shells.bins), unsigned(elementTiles), unsigned(transmitTiles * job.parts));
    sumShellKernel<<<grid, threads, bytes, stream>>>(job, on.parts.data());
    check(cudaGetLastError(), "summing channels");
    addParts<<<unsigned((values + threads - 1) / threads), threads, 0, stream>>>(on.parts.data(), job.parts, values,
                                                                                 on.sums.data());
    check(cudaGetLastError(), "summing channels");
    synthesis.firstSample = shell.firstSample;
    synthesiseKernel<<<synthesisGrid, threads, 0, stream>>>(synthesis, on.sums.data(), on.rf.data());
    check(cudaGetLastError(), "making signals");
    // Whoever stops it need not wait for all that was asked for.
    asked += double(shell.end - shell.first) * double(values);
    if (asked > mostAsked)
    {
      check(await(stream), "summing channels");
      asked = 0.0;
    }
  }
  download(on.rf.data(), data.rf.size(), data.rf.data(), stream, traffic);
  check(await(stream), "summing channels");
  report(progress, 1.0);
  return data;
}

} // namespace sono
