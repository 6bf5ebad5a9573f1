#include "ApicalImage.h"

#include "BeamScenes.h"
#include "Stage.h"

#include "Image/BMode.h"
#include "Image/ScanConvert.h"
#include "Phantoms/ThoraxPhantom.h"

namespace sono {

namespace {

ImageSeconds imageSeconds(const Scene& scene, const ImageSettings& work)
{
  Stopwatch watch;
  const auto lines = a4cLines(work);
  const TracedLines traced = trace(scene, lines, work.tracing);
  const double traceSeconds = watch.lap();
  const RfLines rf = formRf(scene, lines, traced, work.echo);
  const double echoSeconds = watch.lap();
  const BModeLines grey = makeBMode(rf.envelope(), rf.lineCount, rf.sampleCount, rf.sampleMm, BModeSettings());
  scanConvert(work.geometry, grey.grey, grey.sampleCount, grey.sampleMm, 0.23);
  return { traceSeconds, echoSeconds, traceSeconds + echoSeconds + watch.lap() };
}

} // namespace

ImageSettings a4cWith(InterfaceModel model)
{
  ImageSettings settings;
  settings.geometry = test::p42().geometry;
  settings.echo = test::echoOf(test::p42(), settings.geometry.depthMm);
  settings.tracing.model = model;
  settings.matchStages();
  return settings;
}

std::vector<ScanLine> a4cLines(const ImageSettings& settings)
{
  return makeScanLines(settings.geometry, thoraxPhantomA4C().orthonormalized());
}

ImageSeconds warmImageSeconds(const Scene& scene, const ImageSettings& work)
{
  imageSeconds(scene, work);
  return imageSeconds(scene, work);
}

} // namespace sono
