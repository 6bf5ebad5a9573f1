#include "Echo/FormRf.h"

#include "Core/LargeMemory.h"
#include "Core/ParallelFor.h"
#include "Core/SoundSpeed.h"
#include "Echo/EchoSetup.h"
#include "Echo/NestedLines.h"
#include "Echo/RoomPool.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <utility>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int groupLines = 8;      // neighbouring lines that share the generated bricks
constexpr int groupsTogether = 4;  // whose sums are kept at a time: a matrix has thousands of lines
constexpr int bricksPerYield = 32; // milliseconds; a group of deep lines at a high frequency takes seconds

void addTissues(const TissueScatterers& tissues, const std::vector<BeamReach>& beams, const YieldPoint& yieldPoint,
                std::vector<LineSum>& sums)
{
  const LineGrid grid = lineGrid(sums.front());
  TissueScatterers::Buffer buffer;
  forSeenBricks(tissues.grid(), beams, [&](const Vec3i& brick, const std::vector<std::size_t>& seeing) {
    yieldPoint();
    const ScattererView scatterers = tissues.generate(brick, buffer);
    for (const std::size_t i : seeing)
    {
      splat(scatterers, beams[i].beam, grid, sums[i]);
    }
  });
}

void addPoints(const PointScatterers& points, const std::vector<BeamReach>& beams, const YieldPoint& yieldPoint,
               std::vector<LineSum>& sums)
{
  const LineGrid grid = lineGrid(sums.front());
  forSeenBricks(points.grid(), beams, [&](const Vec3i& brick, const std::vector<std::size_t>& seeing) {
    yieldPoint();
    const ScattererView scatterers = points.brick(brick);
    for (const std::size_t i : seeing)
    {
      splat(scatterers, beams[i].beam, grid, sums[i]);
    }
  });
}

/// So many, all zeros.
std::vector<LineSum> takeSums(RoomPool<LineSum>& pool, int count)
{
  std::vector<LineSum> sums;
  for (int l = 0; l < count; ++l)
  {
    sums.push_back(pool.take());
    std::fill(sums.back().iq.begin(), sums.back().iq.end(), 0.0f);
  }
  return sums;
}

void giveSums(std::vector<LineSum> sums, RoomPool<LineSum>& pool)
{
  for (LineSum& sum : sums)
  {
    pool.give(std::move(sum));
  }
}

/// Neighbouring lines, and what has been added to each of them.
struct LineGroup
{
  std::vector<LineSum> scatterers, surfaces;
  std::atomic<int> tasksLeft; ///< who does the last one finishes the lines
};

/// What surfaces or what scatterers add to a group.
struct GroupTask
{
  int group;
  bool ofSurfaces;
};

/// The n-th that is begun. Surfaces, which take longer, come first: the last one is waited for. Of many groups some are
/// taken at a time, since what has been added to one of them waits for the rest.
GroupTask taskAt(int n, int groupCount, int tasksOfGroup)
{
  const int first = n / tasksOfGroup / groupsTogether * groupsTogether;
  const int together = std::min(groupsTogether, groupCount - first);
  const int among = n - first * tasksOfGroup;
  return { first + among % together, tasksOfGroup == 2 && among < together };
}

} // namespace

std::vector<float> RfLines::rf() const
{
  std::vector<std::complex<float>> carrier(static_cast<std::size_t>(sampleCount));
  for (int s = 0; s < sampleCount; ++s)
  {
    const double phase = 4.0 * pi * centreFrequencyMHz / assumedSoundSpeedMmPerUs * (s * sampleMm);
    carrier[std::size_t(s)] = std::complex<float>(std::polar(1.0, phase));
  }
  std::vector<float> out(iq.size());
  parallelFor(lineCount, {}, [&](int line) {
    const std::size_t row = std::size_t(line) * std::size_t(sampleCount);
    for (std::size_t s = 0; s < carrier.size(); ++s)
    {
      out[row + s] = iq[row + s].real() * carrier[s].real() - iq[row + s].imag() * carrier[s].imag();
    }
  });
  return out;
}

std::vector<float> RfLines::envelope() const
{
  std::vector<float> out = largeVector<float>(iq.size());
  parallelFor(lineCount, {}, [&](int line) {
    const std::size_t row = std::size_t(line) * std::size_t(sampleCount);
    for (std::size_t s = row; s < row + std::size_t(sampleCount); ++s)
    {
      out[s] = std::sqrt(iq[s].real() * iq[s].real() + iq[s].imag() * iq[s].imag());
    }
  });
  return out;
}

RfLines formRf(const EchoSources& sources, const std::vector<ScanLine>& lines, const EchoSettings& settings,
               const Progress& progress)
{
  const EchoSetup setup(sources, lines, settings, 0, settings.interactive ? EchoDetail::Moving : EchoDetail::Full);
  RfLines out = setup.emptyRf();
  const ReverberationNodes nodes = setup.finisher.reverberationNodes();
  const int tasksOfGroup = setup.surfaces ? 2 : 1;
  const int groupCount = (out.lineCount + groupLines - 1) / groupLines;
  std::vector<LineGroup> groups(static_cast<std::size_t>(groupCount));
  for (LineGroup& group : groups)
  {
    group.tasksLeft = tasksOfGroup;
  }
  RoomPool<LineSum> lineSums([&] { return setup.finisher.emptySum(); });
  RoomPool<NestedRoom> nestedRooms([] { return NestedRoom(); });
  RoomPool<std::shared_ptr<SurfaceEchoes::Room>> surfaceRooms(SurfaceEchoes::makeRoom);
  RoomPool<LineFinisher::Room> finishingRooms([&] { return setup.finisher.room(); });
  std::atomic<int> begun{ 0 };
  const auto runTask = [&](int, const YieldPoint& yieldPoint) {
    const GroupTask task = taskAt(begun++, groupCount, tasksOfGroup);
    int bricks = 0;
    const YieldPoint brickDone = [&] {
      if (++bricks % bricksPerYield == 0)
      {
        yieldPoint();
      }
    };
    LineGroup& group = groups[std::size_t(task.group)];
    const int first = task.group * groupLines;
    const int last = std::min(first + groupLines, out.lineCount);
    const auto beams = [&](auto beamOf, const std::optional<FieldSight>& sight) {
      std::vector<BeamReach> made;
      for (int l = first; l < last; ++l)
      {
        made.push_back(setup.beams.reachOf(beamOf(l), setup.finisher.reachMm(l), sight ? &*sight : nullptr));
      }
      return made;
    };
    const auto sceneBeam = [&](int l) { return setup.sceneBeam(l); };
    std::vector<LineSum> sums = takeSums(lineSums, last - first);
    if (task.ofSurfaces)
    {
      std::vector<SurfaceIntensity> intensities;
      for (int l = first; l < last; ++l)
      {
        intensities.push_back(setup.finisher.intensity(l));
      }
      const auto room = surfaceRooms.take();
      setup.surfaces->add(beams(sceneBeam, std::nullopt), intensities, brickDone, *room, sums);
      surfaceRooms.give(room);
      group.surfaces = std::move(sums);
    }
    else
    {
      if (setup.tissues)
      {
        addTissues(*setup.tissues, beams(sceneBeam, setup.tissueSight), brickDone, sums);
      }
      if (setup.nested)
      {
        NestedRoom room = nestedRooms.take();
        addNested(setup, beams(sceneBeam, std::nullopt), brickDone, room, sums);
        nestedRooms.give(std::move(room));
      }
      if (sources.points)
      {
        addPoints(*sources.points, beams([&](int l) { return setup.pointBeam(l); }, setup.pointSight), brickDone, sums);
      }
      group.scatterers = std::move(sums);
    }
    if (--group.tasksLeft > 0)
    {
      return;
    }
    LineFinisher::Room room = finishingRooms.take();
    for (int l = first; l < last; ++l)
    {
      const std::size_t at = std::size_t(l - first);
      setup.finisher.finish(l, group.scatterers[at], setup.surfaces ? &group.surfaces[at] : nullptr, nodes, room,
                            out.iq.data() + std::size_t(l) * std::size_t(out.sampleCount));
    }
    finishingRooms.give(std::move(room));
    giveSums(std::move(group.scatterers), lineSums);
    giveSums(std::move(group.surfaces), lineSums);
  };
  parallelFor(tasksOfGroup * groupCount, progress, runTask);
  return out;
}

RfLines formRf(const Scene& scene, const std::vector<ScanLine>& lines, const TracedLines& traced,
               const EchoSettings& settings, const Progress& progress)
{
  return formRf({ &scene, &traced, nullptr }, lines, settings, progress);
}

} // namespace sono
