// The seed's parameter figure and its artefact figure, and the three views of the phantom.
#include "PhantomImaging.h"
#include "Phantoms/TestObjects.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Picture.h"
#include "Probe/ArrayBeam.h"
#include "Simulator.h"
#include "Study.h"

#include "Labels/AssignTissues.h"

#include <algorithm>
#include <cmath>

namespace sono::study {
namespace {

/// A view of the heart as the seed's figure 5 has it: a pulse-echo field focused at 60 mm, 2500 rays, C0 = 0.1 (read in
/// metres), tau 2.0 and gamma 0.1 of the myocardium, and its equations to the letter.
struct HeartView
{
  ScanGeometry geometry;
  TraceSettings tracing;
  EchoSettings echo;
  double tau = 2.0;
  double gamma = 0.1;
};

HeartView seedView(bool quick)
{
  HeartView view;
  ProbePreset preset = readProbePreset(dataFile("probes/phased_p4-2.json"));
  preset.transmitFocusMm = 60.0;
  view.geometry = preset.geometry;
  view.geometry.sectorDeg = 90.0;
  view.geometry.lineCount = quick ? 32 : 128;
  view.echo.centreFrequencyMHz = preset.centreFrequencyMHz;
  view.echo.fractionalBandwidth = preset.fractionalBandwidth;
  view.echo.depthMm = view.geometry.depthMm;
  const ArrayAperture aperture = apertureOf(preset);
  FieldGrid grid = suggestedFieldGrid(aperture, view.echo.depthMm);
  view.echo.field = std::make_shared<PulseEchoField>(pulseEchoField(aperture, grid));
  view.tracing.model = InterfaceModel::Amadou2024;
  view.tracing.pathsPerLine = quick ? 25 : 2500;
  view.tracing.maxCollisions = 10; // the seed's for hearts
  view.tracing.frequencyMHz = view.echo.centreFrequencyMHz;
  view.tracing.depthMm = view.echo.depthMm;
  view.tracing.aperture = preset.aperture();
  view.tracing.echoSampleMm = view.echo.sampleMm();
  return view;
}

/// The same with rough surfaces that echo, which keep energy and so need more collisions.
HeartView ownView(bool quick)
{
  HeartView view = seedView(quick);
  view.tracing.model = InterfaceModel::Acoustic;
  view.tracing.maxCollisions = 20;
  return view;
}

/// The bundled thorax with tau and gamma of the myocardium; without scatterers, boundaries alone echo.
std::unique_ptr<Scene> heartScene(const LabelVolume& volume, const HeartView& view, bool scatterers)
{
  TissueTable table;
  const TissueTable bundled = bundledTissues();
  for (Tissue tissue : bundled.tissues())
  {
    if (tissue.name == "myocardium")
    {
      tissue.tau = view.tau;
      tissue.gamma = view.gamma;
    }
    tissue.scattererProbability = scatterers ? tissue.scattererProbability : 0.0;
    table.add(tissue);
  }
  LabelVolume copy = volume;
  assignTissues(copy, LabelTissueMap::read(dataFile("label_tissues.csv")), table, "air");
  return std::make_unique<Scene>(std::move(copy), table, "air");
}

struct HeartImage
{
  TracedLines traced;
  RfLines rf;
  RfLines boundaries; ///< without speckle
};

HeartImage imageHeart(const LabelVolume& volume, const HeartView& view)
{
  Simulator simulator(heartScene(volume, view, true));
  const auto lines = makeScanLines(view.geometry, thoraxPhantomA4C().orthonormalized());
  HeartImage image;
  const TracedResult traced = simulator.trace(lines, view.tracing);
  image.traced = traced.host();
  image.rf = simulator.formRf(lines, traced, view.echo).host();
  image.boundaries = formRf(*heartScene(volume, view, false), lines, image.traced, view.echo);
  return image;
}

BModeSettings seedDisplay()
{
  BModeSettings bmode;
  bmode.tgcDbPerCm = 1.5; // the seed's
  bmode.dynamicRangeDb = 75.0;
  return bmode;
}

double decibels(double ratio)
{
  return 20.0 * std::log10(std::max(ratio, 1e-9));
}

/// Mean traced intensity in the tissue of some labels, or everywhere from a depth on.
double meanIntensity(const LabelVolume& volume, const std::vector<ScanLine>& lines, const TracedLines& traced,
                     const std::string& labelPrefix, double fromMm)
{
  double sum = 0.0;
  int count = 0;
  for (int l = 0; l < traced.lineCount; ++l)
  {
    for (int b = int(fromMm / traced.binMm); b < traced.binCount; ++b)
    {
      const ScanLine& line = lines[std::size_t(l)];
      const Vec3d place = line.originMm + (b + 0.5) * traced.binMm * line.axis;
      const Vec3i voxel(glm::round(volume.placement.indexFromWorld(place)));
      const Vec3i size = volume.placement.size;
      if (glm::any(glm::lessThan(voxel, Vec3i(0))) || glm::any(glm::greaterThanEqual(voxel, size)))
      {
        continue;
      }
      const auto id = volume.voxels[(std::size_t(voxel.z) * size.y + voxel.y) * size.x + voxel.x];
      if (volume.find(id)->name.rfind(labelPrefix, 0) == 0)
      {
        sum += traced.intensity[std::size_t(l) * traced.binCount + b];
        ++count;
      }
    }
  }
  return count == 0 ? 0.0 : sum / count;
}

/// Of the boundary echoes below the chest wall, which is bright and has no myocardium. In the RF, since Acoustic's
/// surfaces echo there and bring the trace none.
double echoRms(const RfLines& boundaries)
{
  double sum = 0.0;
  for (int l = 0; l < boundaries.lineCount; ++l)
  {
    for (int s = int(40.0 / boundaries.sampleMm); s < boundaries.sampleCount; ++s)
    {
      sum += std::norm(boundaries.iq[std::size_t(l) * std::size_t(boundaries.sampleCount) + std::size_t(s)]);
    }
  }
  return std::sqrt(sum);
}

void drawParameters(Output& output, const HeartView& base, const std::string& name)
{
  struct Change
  {
    const char* name;
    void (*apply)(HeartView&);
  };
  const std::vector<Change> changes{
    { "b: no MCPT", [](HeartView& v) { v.tracing.deterministic = true; } },
    { "c: 500 rays", [](HeartView& v) { v.tracing.pathsPerLine = std::max(5, v.tracing.pathsPerLine / 5); } },
    { "d: 2500 rays", [](HeartView&) {} },
    { "e: C0 = 0.2", [](HeartView& v) { v.tracing.coherenceMm = 200.0; } },
    { "f: gamma = -1.8", [](HeartView& v) { v.gamma = -1.8; } },
    { "g: tau = 2.8", [](HeartView& v) { v.tau = 2.8; } },
    { "h: sigma = 1.5 mm",
      [](HeartView& v) {
        v.echo.field = nullptr;
        v.echo.lateralSigmaMm = v.echo.elevationalSigmaMm = 1.5;
      } },
  };
  const LabelVolume volume = makeThoraxPhantom(output.quick() ? 4.0 : 1.0);
  const ProbePose pose = thoraxPhantomA4C().orthonormalized();
  const auto lines = makeScanLines(base.geometry, pose);
  std::vector<HeartImage> images;
  for (const Change& change : changes)
  {
    HeartView view = base;
    change.apply(view);
    images.push_back(imageHeart(volume, view));
  }

  // One reference for all panels, so that they may be compared: that of panel d.
  BModeSettings bmode = seedDisplay();
  const HeartImage& reference = images[2];
  bmode.referenceAmplitude =
    makeBMode(reference.rf.envelope(), reference.rf.lineCount, reference.rf.sampleCount, reference.rf.sampleMm, bmode)
      .referenceAmplitude;
  bmode.automaticReference = false;
  std::vector<Picture> panels;
  std::vector<std::vector<std::string>> rows;
  const double pixelMm = 0.8;
  for (std::size_t i = 0; i < changes.size(); ++i)
  {
    const HeartImage& image = images[i];
    const BModeLines grey =
      makeBMode(image.rf.envelope(), image.rf.lineCount, image.rf.sampleCount, image.rf.sampleMm, bmode);
    const PlaneImage plane = scanConvert(base.geometry, grey.grey, grey.sampleCount, grey.sampleMm, pixelMm);
    if (panels.empty())
    {
      panels.push_back(pictureOfLabels(volume, base.geometry, pose, plane, image.traced));
    }
    panels.push_back(pictureOf(plane));
    const auto against = [&](const std::string& label, double fromMm) {
      return number(decibels(meanIntensity(volume, lines, image.traced, label, fromMm) /
                             meanIntensity(volume, lines, reference.traced, label, fromMm)));
    };
    rows.push_back({ changes[i].name, against("left_atrium_blood", 0.0), against("aorta", 0.0), against("", 120.0),
                     number(decibels(echoRms(image.boundaries) / echoRms(reference.boundaries))) });
  }
  output.table(
    "phantom_" + name + ".csv",
    { "panel", "intensity in the left atrium dB", "in the aorta dB", "beyond 120 mm dB", "boundary echoes dB" }, rows);
  writePicture(montage(panels, 4), output.file(name + ".png"));
}

/// How a P4-2 sees a test object.
struct ObjectView
{
  std::unique_ptr<Scene> scene;
  PhantomImaging imaging;
  TracedLines traced;
  RfLines rf;
};

/// With the phantom's settings, and a gain that keeps gel alike at all depths.
ObjectView viewObject(TestObject object, bool quick)
{
  TestObjectSettings settings;
  settings.spacingMm = quick ? 2.0 : 0.5;
  ObjectView view{ sceneOf(makeTestObject(object, settings)), phantomImaging(quick ? 32 : 128), {}, {} };
  PhantomImaging& imaging = view.imaging;
  imaging.geometry.depthMm = imaging.tracing.depthMm = imaging.echo.depthMm = 110.0;
  imaging.bmode.tgcDbPerCm = 3.6;
  imaging.bmode.automaticReference = true;
  const auto lines = makeScanLines(imaging.geometry, ProbePose{});
  view.traced = trace(*view.scene, lines, imaging.tracing);
  view.rf = formRf(*view.scene, lines, view.traced, imaging.echo);
  return view;
}

/// Rms envelope 10 to 20 mm behind the sphere on its axis against that at the same depth in plain gel, dB.
double behindSphereDb(const ObjectView& view)
{
  const TestObjectSettings settings;
  const double nearMm = settings.depthMm + 0.5 * settings.diameterMm + 10.0;
  const std::vector<float> envelope = view.rf.envelope();
  const auto power = [&](double fromDeg, double toDeg) {
    double sum = 0.0;
    int count = 0;
    for (int l = 0; l < view.rf.lineCount; ++l)
    {
      const double angle = std::fabs((double(l) / (view.rf.lineCount - 1) - 0.5) * view.imaging.geometry.sectorDeg);
      for (int s = int(nearMm / view.rf.sampleMm);
           angle >= fromDeg && angle <= toDeg && s < int((nearMm + 10.0) / view.rf.sampleMm); ++s)
      {
        const double e = envelope[std::size_t(l) * view.rf.sampleCount + s];
        sum += e * e;
        ++count;
      }
    }
    return sum / count;
  };
  return 10.0 * std::log10(power(0.0, 7.0) / power(22.0, 30.0));
}

Picture pictureOfView(const ObjectView& view, bool labels)
{
  const BModeLines grey =
    makeBMode(view.rf.envelope(), view.rf.lineCount, view.rf.sampleCount, view.rf.sampleMm, view.imaging.bmode);
  const PlaneImage plane = scanConvert(view.imaging.geometry, grey.grey, grey.sampleCount, grey.sampleMm, 0.5);
  return labels ? pictureOfLabels(view.scene->volume(), view.imaging.geometry, ProbePose{}, plane, view.traced)
                : pictureOf(plane);
}

void drawArtefacts(Output& output)
{
  const bool quick = output.quick();
  const ObjectView fluid = viewObject(TestObject::EnhancementSphere, quick);
  const ObjectView bone = viewObject(TestObject::ShadowSphere, quick);
  const ObjectView rib = viewObject(TestObject::Rib, quick);
  output.figure("enhancement_db", behindSphereDb(fluid), "dB");
  // Over the sphere's 2 cm, which by their time are as long as 2.081 cm of gel, gel would have taken this more.
  output.figure("enhancement_theory_db", 2.0 * (0.5 * 2.0 * 1540.0 / 1480.0 - 0.0022 * 2.0) * 3.6, "dB");
  output.figure("shadow_db", behindSphereDb(bone), "dB");
  writePicture(montage({ pictureOfView(fluid, false), pictureOfView(bone, false), pictureOfView(rib, true),
                         pictureOfView(rib, false) },
                       4),
               output.file("artefacts.png"));
}

void drawPhantom(Output& output)
{
  const PhantomBench bench(WireModel::Scatterers, output.quick() ? 2.0 : 0.5);
  const PhantomImaging imaging = phantomImaging(output.quick() ? 32 : 256);
  std::vector<Picture> panels;
  for (int view = 1; view <= phantomViewCount; ++view)
  {
    const RfLines rf = bench.image(imaging, view, 1);
    const BModeLines grey = makeBMode(rf.envelope(), rf.lineCount, rf.sampleCount, rf.sampleMm, imaging.bmode);
    panels.push_back(pictureOf(scanConvert(imaging.geometry, grey.grey, grey.sampleCount, grey.sampleMm, 0.5)));
  }
  writePicture(montage(panels, 3), output.file("phantom.png"));
}

void run(Output& output)
{
  drawParameters(output, seedView(output.quick()), "parameters_seed");
  drawParameters(output, ownView(output.quick()), "parameters");
  drawArtefacts(output);
  drawPhantom(output);
}

const Part part("phantom_figures", run);

} // namespace
} // namespace sono::study
