#include "EchoSkips.h"

#include "Echo/EchoSetup.h"

#include <algorithm>
#include <functional>

namespace sono::study {

namespace {

using Visit = std::function<void(const Vec3i&, const std::vector<std::size_t>&)>;

void forAllBricks(const BrickGrid& grid, const Visit& visit, const std::vector<std::size_t>& beams)
{
  const Vec3i low(glm::floor(grid.lowMm / grid.edgeMm));
  const Vec3i high(glm::ceil(grid.highMm / grid.edgeMm));
  for (int z = low.z; z < high.z; ++z)
  {
    for (int y = low.y; y < high.y; ++y)
    {
      for (int x = low.x; x < high.x; ++x)
      {
        visit(Vec3i(x, y, z), beams);
      }
    }
  }
}

/// The brick's scatterers with one of amplitude 0 for each cell that has none.
ScattererView withAbsent(const ScattererView& view, const Vec3f& centre, TissueScatterers::Buffer& buffer)
{
  for (std::size_t i = std::size_t(view.count); i < buffer.x.size(); ++i)
  {
    buffer.x[i] = centre.x;
    buffer.y[i] = centre.y;
    buffer.z[i] = centre.z;
    buffer.amplitude[i] = 0.0f;
  }
  return { view.x, view.y, view.z, view.amplitude, TissueScatterers::cellCount };
}

BeamReach reachOf(const EchoSetup& setup, int line, const EchoSkips& skips)
{
  BeamReach reach{ setup.sceneBeam(line), setup.finisher.reachMm(line), nullptr };
  if (setup.tissueSight && skips.faint)
  {
    reach.sight = &*setup.tissueSight;
  }
  else if (setup.tissueSight)
  {
    // The ellipse around the table's corners; the weights stay the field's.
    const PulseEchoField& field = *setup.settings.field;
    reach.beam.lateralSigmaMm = float(std::sqrt(2.0) * field.lateralReachMm()) / beamCutSigma;
    reach.beam.elevationalSigmaMm = float(std::sqrt(2.0) * field.elevationalReachMm()) / beamCutSigma;
  }
  return reach;
}

/// The intensities, nowhere so dark that nothing is made there.
TracedLines litUp(TracedLines traced)
{
  for (float& v : traced.intensity)
  {
    v = std::max(v, 1.01e-8f);
  }
  return traced;
}

} // namespace

RfLines formRfBySkipping(const BenchScene& bench, const TracedLines& traced, const EchoSkips& skips)
{
  const TracedLines lit = skips.dark ? TracedLines() : litUp(traced);
  const EchoSources sources{ bench.scene.get(), skips.dark ? &traced : &lit, nullptr };
  const EchoSetup setup(sources, bench.lines, bench.echo);
  RfLines out = setup.emptyRf();
  const ReverberationNodes nodes = setup.finisher.reverberationNodes();
  LineFinisher::Room room = setup.finisher.room();
  const int group = skips.madeTwice ? 8 : 1;
  for (int first = 0; first < out.lineCount; first += group)
  {
    const int last = std::min(first + group, out.lineCount);
    std::vector<LineSum> sums(std::size_t(last - first), setup.finisher.emptySum());
    std::vector<BeamReach> beams;
    std::vector<std::size_t> all;
    for (int l = first; l < last; ++l)
    {
      all.push_back(beams.size());
      beams.push_back(reachOf(setup, l, skips));
    }
    TissueScatterers::Buffer buffer;
    const Visit visit = [&](const Vec3i& brick, const std::vector<std::size_t>& seeing) {
      ScattererView scatterers = setup.tissues->generate(brick, buffer);
      if (!skips.absent)
      {
        scatterers = withAbsent(scatterers, (Vec3f(brick) + 0.5f) * setup.tissues->grid().edgeMm, buffer);
      }
      for (const std::size_t i : seeing)
      {
        splat(scatterers, beams[i].beam, lineGrid(sums[i]), sums[i]);
      }
    };
    if (skips.unseenBricks)
    {
      forSeenBricks(setup.tissues->grid(), beams, visit);
    }
    else
    {
      forAllBricks(setup.tissues->grid(), visit, all);
    }
    for (int l = first; l < last; ++l)
    {
      setup.finisher.finish(l, sums[std::size_t(l - first)], nullptr, nodes, room,
                            out.iq.data() + std::size_t(l) * std::size_t(out.sampleCount));
    }
  }
  return out;
}

double scattererCount(const BenchScene& bench)
{
  const EchoSources sources{ bench.scene.get(), nullptr, nullptr, InterfaceModel::Amadou2024 };
  const EchoSetup setup(sources, bench.lines, bench.echo);
  TissueScatterers::Buffer buffer;
  double count = 0.0;
  forAllBricks(
    setup.tissues->grid(),
    [&](const Vec3i& brick, const std::vector<std::size_t>&) { count += setup.tissues->generate(brick, buffer).count; },
    {});
  return count;
}

} // namespace sono::study
