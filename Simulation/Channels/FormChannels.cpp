#include "Channels/ChannelLoops.h"
#include "Channels/ChannelPlan.h"

#include "Core/ParallelFor.h"

#include <algorithm>

namespace sono {

namespace {

ChannelBlock blockOf(const ChannelPoints& points, std::size_t first, std::size_t end)
{
  ChannelBlock block{};
  for (std::size_t s = 0; s < std::size_t(channelBlock); ++s)
  {
    const bool isThere = first + s < end;
    const std::size_t i = isThere ? first + s : end - 1; // a place that any point may have
    block.x[s] = points.x[i];
    block.y[s] = points.y[i];
    block.z[s] = points.z[i];
    block.re[s] = isThere ? points.re[i] : 0.0f;
    block.im[s] = isThere ? points.im[i] : 0.0f;
    block.lagMm[s] = points.lagMm[i];
    block.sinkNp[s] = points.sinkNp[i];
    block.rise[s] = points.rise[i];
  }
  return block;
}

} // namespace

void sumShell(const ChannelPlan& plan, const ChannelShells& shells, const ChannelShell& shell,
              const std::vector<float>& drive, const Progress& progress, std::vector<float>& sums)
{
  sums.assign(drive.size(), 0.0f);
  const std::size_t perBin = plan.transmits.each.size() * 2 * std::size_t(plan.pieces.padded);
  const int chunks = (shells.bins + channelBins - 1) / channelBins;
  parallelFor(chunks, progress, [&](int number, const YieldPoint& yield) {
    const int first = number * channelBins;
    ChannelChunk chunk{};
    chunk.pieceX = plan.pieces.x.data();
    chunk.pieceZ = plan.pieces.z.data();
    chunk.pieceNormalX = plan.pieces.normalX.data();
    chunk.pieceNormalZ = plan.pieces.normalZ.data();
    chunk.elements = plan.pieces.elements;
    chunk.padded = plan.pieces.padded;
    chunk.perElement = plan.pieces.perElement;
    chunk.halfWidthMm = plan.pieces.halfWidthMm;
    chunk.isSoft = plan.settings.baffle == Baffle::Soft;
    chunk.isFlat = plan.settings.flat;
    chunk.shortestMm = plan.shortestMm;
    chunk.npPerMmMHz = plan.npPerMmMHz;
    chunk.shape = plan.shape;
    chunk.firstMHz = float(shells.frequencyMHz(first));
    chunk.stepMHz = float(shells.stepMHz);
    chunk.centreMHz = float(plan.centreMHz);
    chunk.bins = std::min(channelBins, shells.bins - first);
    chunk.transmits = int(plan.transmits.each.size());
    chunk.drive = drive.data() + std::size_t(first) * perBin;
    ChannelRoom room(chunk.padded, chunk.perElement);
    float* out = sums.data() + std::size_t(first) * perBin;
    for (std::size_t i = shell.first; i < shell.end; i += std::size_t(channelBlock))
    {
      addBlock(chunk, blockOf(shells.points, i, shell.end), room, out);
      if ((i - shell.first) % 4096 == 0)
      {
        yield();
      }
    }
  });
}

ChannelData formChannels(const ChannelPlan& plan, const ChannelPoints& points, const Progress& progress)
{
  ChannelData data = plan.empty();
  const ChannelShells shells = makeShells(plan, points);
  const std::vector<float> drive = driveTable(plan, shells);
  std::vector<float> sums;
  const double all = double(shells.points.size());
  for (const ChannelShell& shell : shells.shells)
  {
    sumShell(plan, shells, shell, drive, partOf(progress, double(shell.first) / all, double(shell.end) / all), sums);
    synthesise(plan, shells, shell, sums, data);
  }
  return data;
}

} // namespace sono
