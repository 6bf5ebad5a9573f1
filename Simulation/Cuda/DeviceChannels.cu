#include "Cuda/DeviceChannels.h"

#include "Core/Progress.h"
#include "Cuda/ChannelKernels.cuh"
#include "Cuda/DeviceImager.h"
#include "Cuda/DeviceMemory.cuh"

#include <algorithm>

namespace sono {
namespace {

constexpr double mostAsked = 3e10;                      ///< points times sums, some tenths of a second
constexpr std::size_t mostSums = std::size_t(16) << 20; ///< of shells that are summed together
constexpr int fullDevice = 4096;                        ///< blocks that keep a large GPU busy

/// What goes up in one piece: each part begins at a whole pair.
class PackedFloats
{
public:
  std::size_t add(const float* from, std::size_t count)
  {
    const std::size_t at = values_.size();
    values_.insert(values_.end(), from, from + count);
    values_.resize((values_.size() + 1) / 2 * 2);
    return at;
  }
  std::size_t add(const std::vector<float>& from) { return add(from.data(), from.size()); }
  const std::vector<float>& values() const { return values_; }

private:
  std::vector<float> values_;
};

/// What stays on the device for all shells.
struct OnDevice
{
  DeviceArray<float> packed, rf, drive, parts, sums;
  DeviceArray<double> delays;
  DeviceArray<DeviceShell> shells;
};

std::vector<DeviceShell> toDevice(const std::vector<ChannelShell>& shells)
{
  std::vector<DeviceShell> out;
  for (const ChannelShell& shell : shells)
  {
    out.push_back({ int(shell.first), int(shell.end), shell.firstSample });
  }
  return out;
}

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
  const ChannelShells shells = makeShells(plan, points);
  if (shells.bins == 0 || shells.shells.empty())
  {
    return plan.empty();
  }
  Traffic traffic;
  OnDevice on;
  const ElementPieces& pieces = plan.pieces;
  PackedFloats packed;
  const std::size_t pieceAt[] = { packed.add(pieces.x), packed.add(pieces.z), packed.add(pieces.normalX),
                                  packed.add(pieces.normalZ) };
  const ChannelPoints& p = shells.points;
  const std::size_t pointAt[] = { packed.add(p.x),  packed.add(p.y),     packed.add(p.z),      packed.add(p.re),
                                  packed.add(p.im), packed.add(p.lagMm), packed.add(p.sinkNp), packed.add(p.rise) };
  const std::size_t weightsAt = packed.add(plan.transmits.weights);
  const std::size_t cosineAt = packed.add(shells.turnCosine);
  const std::size_t sineAt = packed.add(shells.turnSine);
  const std::size_t pulseAt = packed.add(reinterpret_cast<const float*>(shells.pulse.data()), 2 * shells.pulse.size());
  on.packed.upload(packed.values(), stream, traffic);
  on.delays.upload(plan.transmits.delaysUs, stream, traffic);
  on.shells.upload(toDevice(shells.shells), stream, traffic);
  const int transmits = int(plan.transmits.each.size());
  const std::size_t samples = std::size_t(transmits) * std::size_t(pieces.elements) * std::size_t(plan.sampleCount);
  on.rf.resize(samples);
  on.rf.clear(stream);
  const float* floats = on.packed.data();
  ShellJob job{};
  job.pieceX = floats + pieceAt[0];
  job.pieceZ = floats + pieceAt[1];
  job.pieceNormalX = floats + pieceAt[2];
  job.pieceNormalZ = floats + pieceAt[3];
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
  job.transmits = transmits;
  job.points = { floats + pointAt[0], floats + pointAt[1], floats + pointAt[2], floats + pointAt[3],
                 floats + pointAt[4], floats + pointAt[5], floats + pointAt[6], floats + pointAt[7] };
  const std::size_t bytes = std::size_t(tilePoints) * std::size_t(pieces.padded) * sizeof(float2);
  if (bytes > sharedMemoryFor(sumShellKernel))
  {
    throw Error("elementCount is " + std::to_string(pieces.elements) +
                ": the GPU's blocks do not hold so many; use fewer elements or choose the CPU");
  }
  const int transmitTiles = (transmits + tileTransmits - 1) / tileTransmits;
  job.elementTiles = (pieces.padded + tileElements - 1) / tileElements;
  const std::size_t values = std::size_t(shells.bins) * std::size_t(transmits) * 2 * std::size_t(pieces.padded);
  const int all = int(shells.shells.size());
  const int most = int(std::clamp(mostSums / values, std::size_t(1), std::size_t(all)));
  const int blocks = shells.bins * transmitTiles * job.elementTiles * most;
  const int tiles = (largestShell(shells) + tilePoints - 1) / tilePoints;
  job.parts = std::clamp(fullDevice / blocks, 1, std::min(16, tiles));
  on.drive.resize(values);
  on.parts.resize(values * std::size_t(most * job.parts));
  on.sums.resize(values * std::size_t(most));
  driveKernel<<<unsigned((values / 2 + threads - 1) / threads), threads, 0, stream>>>(
    on.delays.data(), floats + weightsAt, shells.stepMHz, shells.firstBin, shells.bins, transmits, job.elements,
    job.padded, on.drive.data());
  check(cudaGetLastError(), "delaying transmits");
  job.drive = on.drive.data();
  SynthesisJob synthesis{ nullptr,           0,
                          shells.bins,       shells.firstBin,
                          shells.samples,    transmits,
                          job.elements,      job.padded,
                          plan.sampleCount,  reinterpret_cast<const float2*>(floats + pulseAt),
                          floats + cosineAt, floats + sineAt };
  const dim3 synthesisGrid(unsigned((plan.sampleCount + synthSamples - 1) / synthSamples),
                           unsigned((transmits * job.elements + synthSignals - 1) / synthSignals));
  double asked = 0.0; // since the device was waited for
  for (int first = 0, count = 0; first < all; first += count)
  {
    const std::size_t begin = shells.shells[std::size_t(first)].first;
    const auto askedUntil = [&](int shell) {
      return double(shells.shells[std::size_t(shell)].end - begin) * double(values);
    };
    count = 1;
    while (count < std::min(most, all - first) && askedUntil(first + count) < mostAsked)
    {
      ++count;
    }
    report(progress, double(begin) / double(p.size()));
    job.shells = on.shells.data() + first;
    const dim3 grid(unsigned(shells.bins), unsigned(count * job.elementTiles), unsigned(transmitTiles * job.parts));
    sumShellKernel<<<grid, threads, bytes, stream>>>(job, on.parts.data());
    check(cudaGetLastError(), "summing channels");
    const std::size_t sums = values * std::size_t(count);
    addParts<<<unsigned((sums + threads - 1) / threads), threads, 0, stream>>>(on.parts.data(), job.parts, sums,
                                                                               on.sums.data());
    check(cudaGetLastError(), "summing channels");
    synthesis.shells = job.shells;
    synthesis.shellCount = count;
    synthesiseKernel<<<synthesisGrid, threads, 0, stream>>>(synthesis, on.sums.data(), on.rf.data());
    check(cudaGetLastError(), "making signals");
    // Whoever stops it need not wait for all that was asked for.
    asked += askedUntil(first + count - 1);
    if (asked > mostAsked)
    {
      check(await(stream), "summing channels");
      asked = 0.0;
    }
  }
  ChannelData data = plan.described();
  const std::shared_ptr<void> back = pinnedMemory(samples * sizeof(float));
  const auto* signals = static_cast<const float*>(back.get());
  download(on.rf.data(), samples, static_cast<float*>(back.get()), stream, traffic);
  check(await(stream), "summing channels");
  data.rf.assign(signals, signals + samples);
  report(progress, 1.0);
  return data;
}

} // namespace sono
