#include "PhantomImaging.h"

#include "Core/Progress.h"
#include "Echo/FieldLevel.h"
#include "Labels/AssignTissues.h"
#include "Probe/ArrayBeam.h"
#include "Study.h"
#include "WireEcho.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sono::study {

namespace {

/// A P4-2 as in the seed, by its data sheets.
ProbePreset phantomProbe()
{
  ProbePreset preset = readProbePreset(dataFile("probes/phased_p4-2.json"));
  preset.transmitFocusMm = 50.0;   // the seed's focus of the phantom study
  preset.centreFrequencyMHz = 3.6; // the seed's
  return preset;
}

} // namespace

PhantomImaging phantomImaging(int lines, Apodization apodization)
{
  PhantomImaging imaging;
  const ProbePreset preset = phantomProbe();
  imaging.geometry = preset.geometry; // a sector of 75 degrees, 160 mm deep: holds all targets of a view
  // 128 lines sample the beam's field without gaps, (75 degrees) / (wavelength / (2 x 20.5 mm)) = 125. Detection
  // doubles its band, so twice as many sample the envelope.
  imaging.geometry.lineCount = lines;

  imaging.echo.centreFrequencyMHz = preset.centreFrequencyMHz;
  imaging.echo.fractionalBandwidth = preset.fractionalBandwidth;
  imaging.echo.samplingMHz = 50.0; // the seed's
  imaging.echo.depthMm = imaging.geometry.depthMm;
  imaging.echo.scattererCellMm = 0.4; // some 20 scatterers in the smallest resolution cell: fully developed speckle
  const ArrayAperture aperture = phantomAperture(apodization);
  imaging.echo.field =
    std::make_shared<PulseEchoField>(pulseEchoField(aperture, suggestedFieldGrid(aperture, imaging.echo.depthMm)));
  imaging.echo.scattererLevelDb = gelLevelDb(imaging.echo);

  imaging.tracing.pathsPerLine = 1000; // the seed's
  imaging.tracing.maxCollisions = 7;   // the seed's
  imaging.tracing.coherenceMm = 100.0; // the seed's 0.1, read in metres as its other lengths are
  imaging.tracing.frequencyMHz = imaging.echo.centreFrequencyMHz;
  imaging.tracing.depthMm = imaging.echo.depthMm;
  imaging.tracing.aperture = preset.aperture();
  imaging.tracing.echoSampleMm = imaging.echo.sampleMm();

  imaging.bmode.tgcDbPerCm = 1.5;      // the seed's
  imaging.bmode.dynamicRangeDb = 75.0; // the seed's
  // The seed's reject of 40 dB is taken as the place of its window, whose scale it does not tell: 40 dB above the
  // bottom of 75 would leave 35, and blacken all gel beyond 9 cm. Gel at the focus gets the middle of the window
  // instead.
  const double gelDb =
    gelDbAt(imaging, preset.transmitFocusMm) + 0.1 * preset.transmitFocusMm * imaging.bmode.tgcDbPerCm;
  imaging.bmode.automaticReference = false;
  imaging.bmode.referenceAmplitude = std::pow(10.0, (gelDb + 0.5 * imaging.bmode.dynamicRangeDb) / 20.0);
  return imaging;
}

ArrayAperture phantomAperture(Apodization apodization)
{
  ArrayAperture aperture = apertureOf(phantomProbe());
  aperture.apodization = apodization;
  return aperture;
}

double gelDbAt(const PhantomImaging& imaging, double depthMm)
{
  const Tissue gel = *bundledTissues().find("phantom_gel");
  const double thereAndBackDb = 0.1 * depthMm * 2.0 * gel.attenuationDbPerCmMHz * imaging.echo.centreFrequencyMHz;
  return imaging.echo.scattererLevelDb + 20.0 * std::log10(gel.scattererSigma) +
         20.0 * std::log10(FieldLevel(*imaging.echo.field).at(depthMm)) - thereAndBackDb;
}

TissueTable bundledTissues()
{
  return TissueTable::read(dataFile("tissues.csv"));
}

std::unique_ptr<Scene> sceneOf(LabelVolume volume, const std::string& outside)
{
  const TissueTable table = bundledTissues();
  const auto unmatched = assignTissues(volume, LabelTissueMap::read(dataFile("label_tissues.csv")), table, outside);
  if (!unmatched.empty())
  {
    throw Error("label " + unmatched.front() + " matches no row of " + dataFile("label_tissues.csv"));
  }
  return std::make_unique<Scene>(std::move(volume), table, outside);
}

PhantomBench::PhantomBench(WireModel wires, double spacingMm)
  : PhantomBench(readPhantomTargets(dataFile("phantom_040gse.csv")), wires, spacingMm)
{
}

PhantomBench::PhantomBench(std::vector<PhantomTarget> targets, WireModel wires, double spacingMm)
  : wires_(wires)
  , targets_(std::move(targets))
{
  settings_.spacingMm = spacingMm;
  settings_.wiresAsVoxels = wires == WireModel::Voxels;
  if (wires == WireModel::Surface)
  {
    surfaces_.push_back(phantomWireSurface(targets_, settings_, bundledTissues()));
  }
  scene_ = sceneOf(makeCalibrationPhantom(targets_, settings_));
}

double PhantomBench::wireMm() const
{
  const auto wire = std::find_if(targets_.begin(), targets_.end(),
                                 [](const PhantomTarget& t) { return t.kind == PhantomTargetKind::Wire; });
  return wire == targets_.end() ? 0.0 : wire->diameterMm;
}

RfLines PhantomBench::image(const PhantomImaging& imaging, int view, unsigned seed) const
{
  const auto lines = makeScanLines(imaging.geometry, phantomViewPose(settings_, view));
  TraceSettings tracing = imaging.tracing;
  tracing.seed = seed;
  EchoSettings echo = imaging.echo;
  echo.seed = seed;
  const TracedLines traced = trace(*scene_, lines, tracing, {}, surfaces_);
  std::unique_ptr<PointScatterers> points;
  if (wires_ == WireModel::Scatterers)
  {
    points =
      std::make_unique<PointScatterers>(phantomWireScatterers(targets_, settings_, wireEchoPerMm(echo, wireMm())));
  }
  return formRf({ scene_.get(), &traced, points.get() }, lines, echo);
}

double valueAt(const PlaneImage& image, double lateralMm, double depthMm)
{
  const double x = (lateralMm - image.lateralMinMm) / image.pixelMm;
  const double y = (depthMm - image.axialMinMm) / image.pixelMm;
  const int i = int(std::floor(x));
  const int j = int(std::floor(y));
  if (i < 0 || j < 0 || i + 1 >= image.width || j + 1 >= image.height)
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const float* row = image.value.data() + std::size_t(j) * std::size_t(image.width) + i;
  const double above = row[0] + (x - i) * (row[1] - row[0]);
  const double below = row[image.width] + (x - i) * (row[image.width + 1] - row[image.width]);
  return above + (y - j) * (below - above);
}

std::vector<float> valuesIn(const PlaneImage& image, double lateralMm, double depthMm, double radiusMm)
{
  std::vector<float> values;
  for (int j = 0; j < image.height; ++j)
  {
    for (int i = 0; i < image.width; ++i)
    {
      const double x = image.lateralMinMm + i * image.pixelMm - lateralMm;
      const double z = image.axialMinMm + j * image.pixelMm - depthMm;
      const std::size_t pixel = std::size_t(j) * std::size_t(image.width) + std::size_t(i);
      if (x * x + z * z < radiusMm * radiusMm && image.mask[pixel])
      {
        values.push_back(image.value[pixel]);
      }
    }
  }
  return values;
}

PlaneImage decibelImage(const PhantomImaging& imaging, const RfLines& rf)
{
  std::vector<float> decibels = rf.envelope();
  for (float& e : decibels)
  {
    e = 20.0f * std::log10(std::max(e, 1e-15f));
  }
  return scanConvert(imaging.geometry, decibels, rf.sampleCount, rf.sampleMm, imaging.pixelMm);
}

} // namespace sono::study
