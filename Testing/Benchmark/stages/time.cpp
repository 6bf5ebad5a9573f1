// Range as time: arrivals of layer stacks, A-lines, mirror images, labels behind fat, how reverberation depends on
// paths
#include "ApicalImage.h"
#include "HarmonicFigures.h"
#include "LayerStack.h"
#include "MaskFit.h"
#include "PhantomScene.h"
#include "ReverberationFigures.h"
#include "Stage.h"

#include "Phantoms/ThoraxLabels.h"
#include "Phantoms/ThoraxPhantom.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace {

using namespace sono;
using namespace sono::test;

constexpr int manyPaths = 1000000;

struct NamedStack
{
  const char* name;
  LayerStack stack;
  double voxelMm = 1.0;
};

std::vector<NamedStack> stacks()
{
  return { { "four layers", namedStack() },
           { "body wall",
             { { { 1.50, 1540.0, 0.1, 9.0 },
                 { 1.38, 1450.0, 0.5, 13.0 },
                 { 1.75, 1590.0, 0.5, 7.0 },
                 { 2.60, 1900.0, 0.8, 0.0 } } } },
           { "plate in water",
             { { { 1.48, 1480.0, 0.02, 24.0 }, { 3.20, 2700.0, 0.4, 9.0 }, { 1.48, 1480.0, 0.02, 0.0 } } } },
           { "layers under a face",
             { { { 1.50, 1500.0, 0.1, 20.3 }, { 2.60, 1750.0, 0.5, 9.1 }, { 1.20, 1400.0, 0.5, 0.0 } }, 0.4 },
             0.7 } };
}

void measureStacks()
{
  StackErrors worst;
  for (const auto& [name, stack, voxelMm] : stacks())
  {
    for (const double bandwidth : { 0.3, 0.6 })
    {
      const StackErrors errors = stackErrors(name, stack, bandwidth, manyPaths, voxelMm);
      worst.rangeMm = std::max(worst.rangeMm, errors.rangeMm);
      worst.amplitudeDb = std::max(worst.amplitudeDb, errors.amplitudeDb);
    }
  }
  printFigure("stack_arrival_error_mm", worst.rangeMm, "mm", "at most 0.02");
  printFigure("stack_amplitude_error_db", worst.amplitudeDb, "dB", "at most 0.5");
}

void measureAlines()
{
  const AlineErrors errors = alineErrors(manyPaths);
  printFigure("aline_spacing_error_mm", errors.spacingMm, "mm", "at most 0.05");
  printFigure("aline_amplitude_error_db", errors.amplitudeDb, "dB", "at most 1");
  printFigure("aline_aperture_error_db", errors.apertureDb, "dB");
  printFigure("tissue_reverberation_error_db", tissueReverberationErrorDb(10000), "dB");
}

void measureDrift(const Scene& scene)
{
  ImageSettings work = a4cWith(InterfaceModel::Acoustic);
  work.tracing.maxCollisions = 20; // a chest's, as in vtkSonoUltrasound
  work.tracing.coherenceMm = 20.0;
  work.geometry.lineCount = 32;
  double worst = 0.0;
  for (const ReverberationDrift& d :
       reverberationDrifts(scene, a4cLines(work), work.tracing, work.echo, { 1000, 10000, 100000 }))
  {
    std::fprintf(stderr, "reverberation, %g to %g mm:", d.fromMm, d.toMm);
    for (const double decibels : d.levelDb)
    {
      std::fprintf(stderr, " %.2f", decibels);
    }
    std::fprintf(stderr, " dB, drift %.3f; the picture %.2f dB\n", d.driftDb, d.pictureDb);
    if (d.levelDb.back() > d.pictureDb - 60.0) // a picture's dynamic range
    {
      worst = std::max(worst, d.driftDb);
    }
  }
  printFigure("reverberation_drift_db", worst, "dB");
}

struct CostRatio
{
  double image;
  double trace;
};

/// What reverberation costs. In turns, so that the machine's moods cancel.
CostRatio reverberationCost(const Scene& scene)
{
  const ImageSettings with = a4cWith(InterfaceModel::Acoustic);
  ImageSettings without = with;
  without.tracing.reverberation = false;
  std::vector<double> image;
  std::vector<double> tracing;
  for (int round = 0; round < 9; ++round)
  {
    const ImageSeconds ofWith = warmImageSeconds(scene, with);
    const ImageSeconds ofWithout = warmImageSeconds(scene, without);
    image.push_back(ofWith.image / ofWithout.image);
    tracing.push_back(ofWith.trace / ofWithout.trace);
  }
  return { medianOf(image), medianOf(tracing) };
}

/// The thorax, all of muscle.
std::unique_ptr<Scene> uniformThorax()
{
  LabelVolume volume = makeThoraxPhantom(1.0);
  std::fill(volume.voxels.begin(), volume.voxels.end(), std::uint16_t(Muscle));
  volume.collectLabels();
  return makePhantomScene(std::move(volume));
}

void measureCost(const Scene& thorax)
{
  const CostRatio heart = reverberationCost(thorax);
  printFigure("reverberation_cost_ratio", heart.image, "times", "at most 1.3");
  printFigure("reverberation_cost_trace_ratio", heart.trace, "times");
  const CostRatio uniform = reverberationCost(*uniformThorax());
  printFigure("idle_reverberation_cost_ratio", uniform.image, "times", "nothing reverberates: 1");
}

void measureTime()
{
  measureStacks();
  measureAlines();
  printFigure("mirror_image_error_mm", mirrorImageErrorMm(4096, Diaphragm::Labels), "mm", "at most 0.5");
  printFigure("mirror_image_mesh_error_mm", mirrorImageErrorMm(4096, Diaphragm::Mesh), "mm", "at most 0.5");
  printFigure("mask_fit_mm", maskFitMm(), "mm", "at most 0.3");
  const auto scene = makePhantomScene(makeThoraxPhantom(1.0));
  measureCost(*scene);
  measureDrift(*scene);
  printFigure("harmonic_growth_error_db", harmonicGrowthErrorDb(), "dB", "at most 0.5");
  printFigure("harmonic_clutter_reduction_db", cystClutterReductionDb(), "dB", "11 to 18");
}

const Stage stage("time", measureTime);

} // namespace
