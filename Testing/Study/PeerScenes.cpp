#include "PeerScenes.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <random>

namespace sono::study {
namespace {

/// The P4-2v as PyMUST has it.
ProbeSettings phasedArray(int elements)
{
  ProbeSettings probe;
  probe.geometry.kind = ScanKind::PhasedSector;
  probe.geometry.sectorDeg = 75.0;
  probe.geometry.depthMm = 80.0;
  probe.centreFrequencyMHz = 2.72;
  probe.fractionalBandwidth = 0.74;
  probe.apertureMm = 0.3 * elements;
  probe.elementWidthMm = 0.25;
  probe.transmitFocusMm = 60.0;
  probe.elementCount = elements;
  return probe;
}

ChannelSettings focusedWaves(int elements)
{
  ChannelSettings settings;
  settings.transmitKind = TransmitKind::FocusedWaves;
  settings.transmitCount = 3;
  settings.transmitSpanDeg = 20.0;
  settings.elementCount = elements;
  settings.device = Device::Cpu;
  return settings;
}

/// Points of speckle a micrometre beside the image plane: in it all programs count the way across alike, but on it
/// PyMUST's elements of a height have no phase.
ChannelPoints speckle(int count)
{
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> lateral(-25.0, 25.0);
  std::uniform_real_distribution<double> axial(20.0, 80.0);
  std::normal_distribution<double> amplitude;
  ChannelPoints points;
  for (int n = 0; n < count; ++n)
  {
    const double x = lateral(random);
    const double z = axial(random);
    points.push(Vec3f(float(x), 1e-3f, float(z)), float(amplitude(random)), 0.0f, 0.0f, 0.0f);
  }
  return points;
}

/// Points on a grid of 0.3 mm, which finer grids have, too, and no two beside each other.
ChannelPoints gridPoints(int count)
{
  std::mt19937_64 random(2);
  ChannelPoints points;
  for (int n = 0; n < count; ++n)
  {
    const double x = 0.3 * double(int(random() % 41) - 20);
    const double z = 0.3 * std::round(27.0 + 40.0 * n / count);
    const double amplitude = 0.5 + double(random() % 1000) / 1000.0;
    points.push(Vec3f(float(x - 0.15), 0.0f, float(z)), float(amplitude), 0.0f, 0.0f, 0.0f);
  }
  return points;
}

} // namespace

ChannelPlan PeerScene::plan(std::shared_ptr<const SampledPulse> pulse) const
{
  return ChannelPlan(settings, probe, std::move(pulse));
}

std::vector<PeerScene> peerScenes(bool quick)
{
  const int count = quick ? 60 : 1000;
  std::vector<PeerScene> scenes;

  PeerScene plane;
  plane.name = "plane";
  plane.words = "two dimensions, soft baffle, as SIMUS has them; pulse of SIMUS";
  plane.settings = focusedWaves(64);
  plane.settings.flat = true;
  plane.probe = phasedArray(64);
  plane.waves = "flat";
  plane.pulse = "simus";
  plane.points = speckle(count);
  scenes.push_back(plane);

  PeerScene lens = plane;
  lens.name = "lens";
  lens.words = "elements 14 mm high behind a lens of 60 mm, soft baffle; pulse of SIMUS";
  lens.settings.flat = false;
  lens.probe.elevationApertureMm = 14.0;
  lens.probe.elevationFocusMm = 60.0;
  lens.waves = "sphere";
  scenes.push_back(lens);

  PeerScene array = lens;
  array.name = "array";
  array.words = "elements 0.5 mm high without a lens, so low that points lie in their far field; rigid baffle; four "
                "periods under a Hann window, as zea has them";
  array.settings.baffle = Baffle::Rigid;
  array.probe.elevationApertureMm = 0.5;
  array.probe.elevationFocusMm = 0.0;
  array.pulse = "hann";
  scenes.push_back(array);

  PeerScene waves = plane;
  waves.name = "waves";
  waves.words =
    "line sources and points that are a little softer than water, in two dimensions, points 8 to 20 mm deep "
    "on a grid of 0.3 mm; a Gaussian burst";
  waves.settings = focusedWaves(32);
  waves.settings.flat = true;
  waves.settings.baffle = Baffle::Rigid;
  waves.settings.transmitCount = 1;
  waves.settings.transmitDistanceMm = 15.0;
  waves.probe = phasedArray(32);
  waves.probe.geometry.depthMm = 22.0;
  waves.probe.elementWidthMm = 1e-3;
  waves.waves = "cylinder";
  waves.pulse = "burst";
  waves.deviationUs = 0.22;
  waves.points = gridPoints(quick ? 5 : 24);
  scenes.push_back(waves);
  return scenes;
}

void writePeerScenes(const Output& output, const std::vector<PeerScene>& scenes)
{
  nlohmann::json all;
  for (const PeerScene& scene : scenes)
  {
    const ChannelPlan plan = scene.plan();
    nlohmann::json one;
    one["name"] = scene.name;
    one["waves"] = scene.waves;
    one["pulse"] = scene.pulse;
    one["deviation"] = scene.deviationUs;
    one["baffle"] = scene.settings.baffle == Baffle::Soft ? "soft" : "rigid";
    one["centre"] = scene.probe.centreFrequencyMHz;
    one["bandwidth"] = scene.probe.fractionalBandwidth;
    one["width"] = plan.elements.widthMm;
    one["height"] = scene.probe.elevationApertureMm;
    one["lens"] = scene.waves == "sphere" ? scene.probe.elevationFocusMm : 0.0;
    one["sampling"] = plan.samplingMHz;
    one["nodesAlong"] = scene.waves == "cylinder" ? 1 : 4;
    one["nodesAcross"] = scene.probe.elevationFocusMm > 0.0 ? 24 : 8;
    for (std::size_t n = 0; n < plan.elements.centresMm.size(); ++n)
    {
      one["elementX"].push_back(plan.elements.centresMm[n].x);
    }
    for (std::size_t t = 0; t < plan.transmits.each.size(); ++t)
    {
      nlohmann::json delays;
      for (std::size_t n = 0; n < plan.elements.centresMm.size(); ++n)
      {
        delays.push_back(plan.transmits.delayUs(t, n));
      }
      one["delays"].push_back(delays);
    }
    for (std::size_t n = 0; n < scene.points.size(); ++n)
    {
      one["points"].push_back({ scene.points.x[n], scene.points.y[n], scene.points.z[n], scene.points.re[n] });
    }
    all.push_back(one);
  }
  std::ofstream file(output.file("peers_scenes.json"));
  file << all.dump();
  file.flush();
  if (!file)
  {
    throw Error("'" + output.file("peers_scenes.json").string() +
                "' cannot be written: choose a folder that you may write to");
  }
}

} // namespace sono::study
