// A whole image, A4C of the bundled thorax at 1 mm: 128 lines x 1000 paths x 7 collisions, all cores.
#include "Echo/FormRf.h"
#include "Image/BMode.h"
#include "Image/ScanConvert.h"
#include "PhantomScene.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Stage.h"
#include "Trace/Trace.h"

namespace sono {
namespace {

struct Workload
{
  ScanGeometry geometry;
  TraceSettings tracing;
  EchoSettings echo;
  BModeSettings bmode;
  double pixelMm = 0.23;
};

Workload a4cWorkload()
{
  Workload work;
  work.geometry.kind = ScanKind::PhasedSector;
  work.geometry.lineCount = 128;
  work.geometry.depthMm = 160.0;
  work.tracing.pathsPerLine = 1000;
  work.tracing.maxCollisions = 7;
  work.tracing.depthMm = work.geometry.depthMm;
  work.echo.depthMm = work.geometry.depthMm;
  work.tracing.frequencyMHz = work.echo.centreFrequencyMHz;
  work.tracing.echoSampleMm = work.echo.sampleMm();
  return work;
}

struct Seconds
{
  double trace = 0.0;
  double echo = 0.0;
  double bmode = 0.0;
  double scan = 0.0;
  double total() const { return trace + echo + bmode + scan; }
};

Seconds makeImage(const Scene& scene, const ProbePose& pose, const Workload& work)
{
  Seconds seconds;
  Stopwatch watch;
  const auto lines = makeScanLines(work.geometry, pose);
  const TracedLines traced = trace(scene, lines, work.tracing);
  seconds.trace = watch.lap();
  const RfLines rf = formRf(scene, lines, traced, work.echo);
  seconds.echo = watch.lap();
  const BModeLines bmode = makeBMode(rf.envelope(), rf.lineCount, rf.sampleCount, rf.sampleMm, work.bmode);
  seconds.bmode = watch.lap();
  const PlaneImage image = scanConvert(work.geometry, bmode.grey, bmode.sampleCount, bmode.sampleMm, work.pixelMm);
  seconds.scan = watch.lap();
  return seconds;
}

double medianOver(const std::vector<Seconds>& runs, double (*pick)(const Seconds&))
{
  std::vector<double> values(runs.size());
  std::transform(runs.begin(), runs.end(), values.begin(), pick);
  return medianOf(values);
}

void measureImage()
{
  LabelVolume volume = makeThoraxPhantom(1.0);
  Stopwatch watch;
  const auto scene = makePhantomScene(std::move(volume));
  const double sceneSeconds = watch.lap();

  const ProbePose pose = thoraxPhantomA4C().orthonormalized();
  const Workload work = a4cWorkload();
  const double firstSeconds = makeImage(*scene, pose, work).total();
  std::vector<Seconds> runs(5);
  for (Seconds& run : runs)
  {
    run = makeImage(*scene, pose, work);
  }

  printFigure("image_a4c_s", medianOver(runs, [](const Seconds& s) { return s.total(); }), "s");
  printFigure("image_a4c_peak_mb", peakMegabytes(), "MB");
  printFigure("image_first_s", firstSeconds, "s"); // fills the scene's caches
  printFigure("image_scene_build_s", sceneSeconds, "s");
  printFigure("image_trace_s", medianOver(runs, [](const Seconds& s) { return s.trace; }), "s");
  printFigure("image_echo_s", medianOver(runs, [](const Seconds& s) { return s.echo; }), "s");
  printFigure("image_bmode_s", medianOver(runs, [](const Seconds& s) { return s.bmode; }), "s");
  printFigure("image_scan_s", medianOver(runs, [](const Seconds& s) { return s.scan; }), "s");
}

const Stage stage("image", measureImage);

} // namespace
} // namespace sono
