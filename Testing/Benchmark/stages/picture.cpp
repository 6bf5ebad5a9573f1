// The picture: echoes of surfaces and boundaries, levels and statistics of speckle, beams, the pulse's frequency, costs
#include "ApicalImage.h"
#include "BeamFigures.h"
#include "BoundaryEchoes.h"
#include "Folders.h"
#include "PhantomScene.h"
#include "SpeckleBands.h"
#include "Stage.h"
#include "SurfaceFigures.h"
#include "TraceFigures.h"

#include "Image/BMode.h"
#include "Image/ScanConvert.h"
#include "ImageSettings.h"
#include "Phantoms/ThoraxPhantom.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>

namespace {

using namespace sono;
using namespace sono::test;

/// The largest modulus of some errors in dB; each is noted on the standard error.
class Worst
{
public:
  explicit Worst(std::string name)
    : name_(std::move(name))
  {
  }
  void add(const std::string& where, double decibels)
  {
    std::fprintf(stderr, "%s %s: %.3f dB\n", name_.c_str(), where.c_str(), decibels);
    if (std::abs(decibels) > worst_)
    {
      worst_ = std::abs(decibels);
      where_ = where;
    }
  }
  double print() const
  {
    printFigure(name_, worst_, "dB");
    std::fprintf(stderr, "%s is worst at %s\n", name_.c_str(), where_.c_str());
    return worst_;
  }

private:
  std::string name_;
  std::string where_;
  double worst_ = 0.0;
};

std::string text(double value)
{
  char out[32];
  std::snprintf(out, sizeof out, "%g", value);
  return out;
}

void measurePlanes()
{
  Worst target("plane_echo_smooth_target_error_db");
  Worst labels("plane_echo_smooth_labels_error_db");
  Worst coherent("plane_echo_coherent_share_error_db");
  Worst rough("plane_echo_rough_error_db");
  for (const double degrees : { 0.0, 2.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 40.0 })
  {
    const std::string where = text(degrees) + " degrees";
    target.add(where, planeOfTargetErrorDb(degrees, 0.0));
    for (const double offsetMm : { 0.03, 0.28 })
    {
      labels.add(where + ", labels moved by " + text(offsetMm), planeOfLabelsErrorDb(degrees, 0.0, offsetMm));
    }
    if (degrees <= 10.0)
    {
      coherent.add(where, planeOfTargetErrorDb(degrees, 0.03));
    }
    for (const double roughnessMm : { 0.05, 0.1, 0.2 })
    {
      rough.add(where + ", " + text(roughnessMm) + " mm rough", roughPlaneErrorDb(degrees, roughnessMm, 1.0));
    }
  }
  const double worst = std::max(std::max(target.print(), labels.print()), std::max(coherent.print(), rough.print()));
  printFigure("plane_echo_error_db", worst, "dB", "at most 1");
}

void measureBalls()
{
  Worst target("sphere_echo_target_error_db");
  Worst labels("sphere_echo_labels_error_db");
  for (const double radiusMm : { 5.0, 10.0, 20.0, 50.0 })
  {
    const auto add = [&](Worst& worst, const std::string& where, const BallErrors& errors) {
      worst.add(where + ", front", errors.frontDb);
      worst.add(where + ", back", errors.backDb);
    };
    add(target, text(radiusMm) + " mm", ballOfTargetErrors(radiusMm));
    for (const double offsetMm : { 0.13, 0.38 })
    {
      add(labels, text(radiusMm) + " mm, moved by " + text(offsetMm), ballOfLabelsErrors(radiusMm, offsetMm));
    }
  }
  printFigure("sphere_echo_error_db", std::max(target.print(), labels.print()), "dB", "at most 1");
}

void measureIntensities()
{
  double matched = 0.0;
  for (const double heightMm : { 0.0, 0.1, 1.0, 10.0 })
  {
    matched = std::max(matched, matchedBoundaryDb(heightMm));
  }
  printFigure("matched_boundary_db", matched, "dB", "at most 0.001");
  double enhancement = 0.0;
  for (const double heightMm : { 0.0, 0.02, 0.1, 0.5 })
  {
    for (const double decibels : enhancementsDb(heightMm))
    {
      enhancement = std::max(enhancement, std::abs(decibels - waterCystEnhancementDb));
    }
  }
  printFigure("enhancement_error_db", enhancement, "dB", "at most 0.3");
}

void measureBeams()
{
  const WidthErrors widths = widthErrors();
  printFigure("lateral_width_error_percent", 100.0 * std::max(widths.gaussian, widths.field), "%", "at most 10");
  printFigure("lateral_width_gaussian_to_elements_percent", 100.0 * widths.gaussianToElements, "%");
  printFigure("field_table_error_db", fieldTableErrorDb(), "dB", "at most 0.3");
  printFigure("downshift_error_percent", 100.0 * downshiftError(), "%", "at most 2");
}

void measureSpeckle()
{
  const TissueTable tissues = TissueTable::read(dataFile("tissues.csv"));
  for (const SpeckleBand& band : speckleBands(*tissues.find("liver")))
  {
    printFigure("speckle_snr_" + text(band.depthMm) + "_mm", band.snr, "1", "1.89 to 1.93");
    std::fprintf(stderr, "speckle at %g mm: %.0f independent samples, which tell the SNR to +-%.4f (one deviation)\n",
                 band.depthMm, band.independentSamples, band.deviation());
  }
}

void measureDrift(const Scene& scene)
{
  ImageSettings work = a4cWith(InterfaceModel::Acoustic);
  work.tracing.maxCollisions =
    20; // a chest's, as in vtkSonoUltrasound: beyond the seventh boundary there is more to see
  work.tracing.coherenceMm = 20.0;
  const std::vector<int> paths{ 100, 1000, 10000, 100000 };
  constexpr int leastCrossings = 10;
  double worst = 0.0;
  for (const BoundaryDrift& b : boundaryDrifts(scene, a4cLines(work), work.tracing, work.echo, paths, leastCrossings))
  {
    std::fprintf(stderr, "%s, %d crossings:", b.tissues.c_str(), b.crossings);
    for (const double decibels : b.medianDb)
    {
      std::fprintf(stderr, " %.2f", decibels);
    }
    std::fprintf(stderr, " dB, drift %.3f\n", b.driftDb);
    worst = std::max(worst, b.driftDb);
  }
  printFigure("boundary_echo_drift_db", worst, "dB", "at most 0.5");
}

/// Whole images, made in turns so that the machine's moods cancel: medians of the quotients.
void measureTimes(const Scene& scene)
{
  const ImageSettings acoustic = a4cWith(InterfaceModel::Acoustic);
  const ImageSettings amadou = a4cWith(InterfaceModel::Amadou2024);
  ImageSettings field = acoustic;
  field.echo.arrayField = std::make_shared<ArrayField>(apertureOf(p42()), field.echo.depthMm);
  std::vector<double> image;
  std::vector<double> tracing;
  std::vector<double> echo;
  std::vector<double> fieldToGaussian;
  for (int round = 0; round < 7; ++round)
  {
    const ImageSeconds ofAcoustic = warmImageSeconds(scene, acoustic);
    const ImageSeconds ofAmadou = warmImageSeconds(scene, amadou);
    const ImageSeconds ofField = warmImageSeconds(scene, field);
    image.push_back(ofAcoustic.image / ofAmadou.image);
    tracing.push_back(ofAcoustic.trace / ofAmadou.trace);
    echo.push_back(ofAcoustic.echo / ofAmadou.echo);
    fieldToGaussian.push_back(ofField.image / ofAcoustic.image);
  }
  // What the whole image costs beside the first wave's is alternate.py's to say.
  printFigure("image_acoustic_to_amadou_ratio", medianOf(image), "times");
  printFigure("image_acoustic_to_amadou_trace_ratio", medianOf(tracing), "times");
  printFigure("image_acoustic_to_amadou_echo_ratio", medianOf(echo), "times");
  printFigure("image_field_to_gaussian_ratio", medianOf(fieldToGaussian), "times", "at most 3");
}

void measurePicture()
{
  measureIntensities();
  measureBeams();
  measureBalls();
  measurePlanes();
  measureSpeckle();
  const auto scene = makePhantomScene(makeThoraxPhantom(1.0));
  measureTimes(*scene);
  measureDrift(*scene);
}

const Stage picture("picture", measurePicture);

} // namespace
