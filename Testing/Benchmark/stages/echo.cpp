// Image formation: scene S1 on one thread and its error, A4C of the bundled thorax with a Gaussian beam and with the
// field of a P4-2, a change of gain, speckle statistics.
#include "Core/SoundSpeed.h"
#include "Echo/FormRf.h"
#include "EchoScenes.h"
#include "Folders.h"
#include "Image/BMode.h"
#include "Image/ScanConvert.h"
#include "PhantomScene.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Probe/ArrayBeam.h"
#include "Stage.h"
#include "Trace/Trace.h"

#include <tbb/global_control.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numeric>

namespace sono {
namespace {

/// Error of the real RF against the direct sum on eight lines.
double rfError(const test::SceneS1& s1, const RfLines& lines)
{
  const std::vector<float> rf = lines.rf();
  const double twoK = 4.0 * M_PI * s1.settings.centreFrequencyMHz / assumedSoundSpeedMmPerUs;
  double error = 0.0;
  double power = 0.0;
  for (int line = 5; line < lines.lineCount; line += 16)
  {
    const auto reference = test::directIq(s1.points, s1.lines[std::size_t(line)], s1.settings);
    for (std::size_t s = 0; s < reference.size(); ++s)
    {
      const double exact = (reference[s] * std::polar(1.0, twoK * double(s) * lines.sampleMm)).real();
      error += std::pow(rf[std::size_t(line) * reference.size() + s] - exact, 2);
      power += exact * exact;
    }
  }
  return std::sqrt(error / power);
}

void measureS1()
{
  const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
  const test::SceneS1 s1;
  const double sortSeconds = medianSeconds([&] { PointScatterers sorted(s1.points); });
  const PointScatterers sorted(s1.points);
  RfLines rf;
  const double formSeconds = medianSeconds([&] { rf = formRf({ nullptr, nullptr, &sorted }, s1.lines, s1.settings); });
  const double realSeconds = medianSeconds([&] { rf.rf(); });
  printFigure("cole_s1_one_thread_s", sortSeconds + formSeconds + realSeconds, "s"); // IQ and RF from a plain list
  printFigure("cole_s1_sort_s", sortSeconds, "s");
  printFigure("cole_s1_iq_s", formSeconds, "s");
  printFigure("cole_s1_rf_s", realSeconds, "s");
  printFigure("cole_nrmse", rfError(s1, rf), "1");
}

void measureA4C()
{
  const auto scene = makePhantomScene(makeThoraxPhantom(1.0));
  ScanGeometry geometry;
  geometry.kind = ScanKind::PhasedSector;
  geometry.lineCount = 128;
  geometry.depthMm = 160.0;
  EchoSettings echo;
  echo.depthMm = geometry.depthMm;
  TraceSettings tracing;
  tracing.depthMm = geometry.depthMm;
  tracing.frequencyMHz = echo.centreFrequencyMHz;
  tracing.echoSampleMm = echo.sampleMm();
  const auto lines = makeScanLines(geometry, thoraxPhantomA4C().orthonormalized());
  const TracedLines traced = trace(*scene, lines, tracing);

  RfLines rf;
  printFigure("echo_a4c_s", medianSeconds([&] { rf = formRf(*scene, lines, traced, echo); }), "s");

  ArrayAperture p42 = apertureOf(readProbePreset(dataFile("probes/phased_p4-2.json")));
  p42.centreFrequencyMHz = echo.centreFrequencyMHz;
  p42.fractionalBandwidth = echo.fractionalBandwidth;
  EchoSettings withField = echo;
  withField.field = std::make_shared<PulseEchoField>(pulseEchoField(p42, suggestedFieldGrid(p42, geometry.depthMm)));
  printFigure("echo_field_a4c_s", medianSeconds([&] { formRf(*scene, lines, traced, withField); }), "s");

  const std::vector<float> envelope = rf.envelope();
  BModeSettings bmode;
  const auto changeGain = [&] {
    const BModeLines grey = makeBMode(envelope, rf.lineCount, rf.sampleCount, rf.sampleMm, bmode);
    scanConvert(geometry, grey.grey, grey.sampleCount, grey.sampleMm, 0.23);
  };
  printFigure("gain_change_s", medianSeconds(changeGain), "s"); // log compression and scan conversion
}

void measureSpeckle()
{
  std::vector<double> ratios;
  for (unsigned seed = 1; seed <= 10; ++seed)
  {
    ratios.push_back(test::signalToNoise(test::speckleEnvelope(seed)));
  }
  printFigure("speckle_snr", std::accumulate(ratios.begin(), ratios.end(), 0.0) / double(ratios.size()), "1");
}

const Stage stage("echo", [] {
  measureS1();
  measureA4C();
  measureSpeckle();
});

} // namespace
} // namespace sono
