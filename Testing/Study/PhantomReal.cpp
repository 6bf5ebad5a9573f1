// The phantom 040GSE as a real linear probe shows it, beside ours: level and gCNR of masses, width of wires, speckle.
// The real figures were measured in two pictures (ITKPOCUS, Apache-2.0) by the same definitions.
#include "Detectability.h"
#include "PhantomImaging.h"
#include "Picture.h"
#include "Simulator.h"
#include "Study.h"

#include <algorithm>
#include <cmath>

namespace sono::study {
namespace {

constexpr double rangeDb = 60.0;
constexpr double regionMm = 2.4; // radius of what is compared

/// What the scanner's screen says: H 10 MHz, 40 mm, DR 60, focus 25 mm. The elements, which it does not tell, are those
/// of a common linear array.
ImageSettings scanner(bool isSmoothed, bool isQuick)
{
  ProbePreset preset = readProbePreset(dataFile("probes/linear_l14.json"));
  preset.transmitFocusMm = 25.0;
  ImageSettings s;
  s.geometry = preset.geometry;
  s.geometry.depthMm = 40.0;
  s.geometry.lineCount = isQuick ? 64 : 256;
  s.echo.imagingMode = ImagingMode::Harmonic;
  s.echo.centreFrequencyMHz = 10.0;
  s.echo.fractionalBandwidth = 0.4; // a harmonic's, which is filtered out of what else returns (chosen)
  s.echo.depthMm = s.geometry.depthMm;
  s.echo.aperture = preset.aperture();
  s.echo.beam = BeamForm::Computed;
  s.bmode.dynamicRangeDb = rangeDb;
  s.bmode.tgcDbPerCm = 7.5; // evens out the gel's 0.5 dB/cm/MHz: 5 MHz on the way there, 10 MHz on the way back
  if (isSmoothed)
  {
    // Chosen by the speckle of plain gel in the real pictures, its SD and size, all three together; nothing else was.
    s.bmode.axialSmoothingMm = 0.2;
    s.bmode.lateralSmoothingLines = 5.0 * s.geometry.lineCount / 256.0;
  }
  s.pixelMm = isQuick ? 0.15 : 0.05;
  s.matchStages();
  return s;
}

/// The phantom's scene, and what the wires are to the tracer.
struct Bench
{
  CalibrationPhantomSettings phantom;
  std::vector<PhantomTarget> targets = readPhantomTargets(dataFile("phantom_040gse_near.csv"));
  std::vector<TargetSurface> wires;
  std::shared_ptr<const Scene> scene;

  explicit Bench(bool isQuick)
  {
    phantom.spacingMm = isQuick ? 1.0 : 0.25;
    phantom.thicknessMm = 12.0;
    wires.push_back(phantomWireSurface(targets, phantom, bundledTissues()));
    scene = sceneOf(makeCalibrationPhantom(targets, phantom));
  }

  /// Grey levels 0 to 1.
  PlaneImage picture(const ImageSettings& settings, int view, unsigned seed) const
  {
    ImageInput input;
    input.pose = phantomViewPose(phantom, view);
    input.settings = settings;
    input.settings.echo.seed = seed;
    input.settings.tracing.seed = seed;
    input.targets = wires;
    return Simulator(scene).image(input).plane().host();
  }
};

/// The levels of a disc in dB of the range, as the real picture's grey map is taken to be.
std::vector<float> disc(const PlaneImage& image, double lateralMm, double depthMm, double radiusMm)
{
  std::vector<float> values = valuesIn(image, lateralMm, depthMm, radiusMm);
  std::transform(values.begin(), values.end(), values.begin(), [](float grey) { return float(rangeDb) * grey; });
  return values;
}

double meanOf(const std::vector<float>& values)
{
  double sum = 0.0;
  for (const float value : values)
  {
    sum += value;
  }
  return sum / double(values.size());
}

double deviationOf(const std::vector<float>& values)
{
  const double mean = meanOf(values);
  double sum = 0.0;
  for (const float value : values)
  {
    sum += (value - mean) * (value - mean);
  }
  return std::sqrt(sum / double(values.size()));
}

/// Where a curve that is 1 at shift 0 falls to half, twice.
double widthAtHalf(const std::vector<double>& curve, double stepMm)
{
  for (std::size_t k = 1; k < curve.size(); ++k)
  {
    if (curve[k] < 0.5)
    {
      return 2.0 * stepMm * (double(k) - 1.0 + (curve[k - 1] - 0.5) / (curve[k - 1] - curve[k]));
    }
  }
  return NAN;
}

/// Width of the autocorrelation of grey levels, along or across the lines, in a square of plain gel.
double speckleMm(const PlaneImage& image, bool axial)
{
  const int side = int(10.0 / image.pixelMm);
  const int left = int((-5.0 - image.lateralMinMm) / image.pixelMm);
  const int top = int((16.5 - image.axialMinMm) / image.pixelMm);
  std::vector<float> patch;
  for (int j = 0; j < side; ++j)
  {
    const float* row = image.value.data() + std::size_t(top + j) * std::size_t(image.width) + left;
    patch.insert(patch.end(), row, row + side);
  }
  // Without what the TGC leaves along the lines and the array.
  std::vector<double> ofRow(std::size_t(side), 0.0);
  std::vector<double> ofColumn(std::size_t(side), 0.0);
  const double all = meanOf(patch);
  for (int j = 0; j < side; ++j)
  {
    for (int i = 0; i < side; ++i)
    {
      ofRow[std::size_t(j)] += patch[std::size_t(j * side + i)] / side;
      ofColumn[std::size_t(i)] += patch[std::size_t(j * side + i)] / side;
    }
  }
  for (int j = 0; j < side; ++j)
  {
    for (int i = 0; i < side; ++i)
    {
      patch[std::size_t(j * side + i)] -= float(ofRow[std::size_t(j)] + ofColumn[std::size_t(i)] - 2.0 * all);
    }
  }
  const double mean = meanOf(patch);
  std::vector<double> curve;
  for (int k = 0; k < side / 2; ++k)
  {
    double sum = 0.0;
    const int rows = axial ? side - k : side;
    const int columns = axial ? side : side - k;
    for (int j = 0; j < rows; ++j)
    {
      for (int i = 0; i < columns; ++i)
      {
        const int other = axial ? (j + k) * side + i : j * side + i + k;
        sum += (patch[std::size_t(j * side + i)] - mean) * (patch[std::size_t(other)] - mean);
      }
    }
    curve.push_back(sum / (double(rows) * columns));
  }
  const double power = curve.front();
  for (double& value : curve)
  {
    value /= power;
  }
  return widthAtHalf(curve, image.pixelMm);
}

/// How far from its brightest pixel a wire's echo falls by 6 dB, to both sides.
double wireMm(const PlaneImage& image, const PhantomTarget& wire, bool axial)
{
  int peak[2] = { 0, 0 };
  float most = -1.0f;
  const auto at = [&](int i, int j) { return image.value[std::size_t(j) * std::size_t(image.width) + std::size_t(i)]; };
  for (int j = 0; j < image.height; ++j)
  {
    for (int i = 0; i < image.width; ++i)
    {
      const double x = image.lateralMinMm + i * image.pixelMm - wire.lateralMm;
      const double z = image.axialMinMm + j * image.pixelMm - wire.depthMm;
      if (std::hypot(x, z) < 0.7 && at(i, j) > most)
      {
        most = at(i, j);
        peak[0] = i;
        peak[1] = j;
      }
    }
  }
  double width = 0.0;
  for (const int way : { -1, 1 })
  {
    float before = most;
    for (int k = 1; k < int(3.0 / image.pixelMm); ++k)
    {
      const float here = axial ? at(peak[0], peak[1] + way * k) : at(peak[0] + way * k, peak[1]);
      const float half = most - float(6.0206 / rangeDb);
      if (here < half)
      {
        width += image.pixelMm * (k - 1 + double((before - half) / (before - here)));
        break;
      }
      before = here;
    }
  }
  return width;
}

struct RealMass
{
  const char* name;
  double levelDb;
  double gcnr;
};
const RealMass realMasses[] = { { "mass_m6", -7.1, 0.90 }, { "mass_m3", -3.0, 0.50 }, { "mass_p3", 2.0, 0.36 } };

void run(Output& output)
{
  const Bench bench(output.quick());
  const unsigned seeds = output.quick() ? 1 : 3;
  std::vector<std::vector<std::string>> rows;
  std::vector<Picture> panels;
  for (const bool isSmoothed : { false, true })
  {
    const ImageSettings settings = scanner(isSmoothed, output.quick());
    const std::string how = isSmoothed ? "" : "_without_smoothing";
    double levelError = 0.0;
    double gcnrError = 0.0;
    double lateral = 0.0, axial = 0.0, deviation = 0.0;
    double wireWidth[2] = { 0.0, 0.0 };
    std::vector<double> level(std::size(realMasses)), gcnr(std::size(realMasses));
    double anechoicDb = 0.0, anechoicGcnr = 0.0;
    for (unsigned seed = 1; seed <= seeds; ++seed)
    {
      const PlaneImage masses = bench.picture(settings, 1, seed);
      const PlaneImage wires = bench.picture(settings, 2, seed);
      for (std::size_t n = 0; n < bench.targets.size(); ++n)
      {
        const PhantomTarget& target = bench.targets[n];
        if (target.kind == PhantomTargetKind::Wire)
        {
          const double count = double(std::count_if(bench.targets.begin(), bench.targets.end(),
                                                    [](const auto& t) { return t.kind == PhantomTargetKind::Wire; }));
          wireWidth[0] += wireMm(wires, target, false) / count / seeds;
          wireWidth[1] += wireMm(wires, target, true) / count / seeds;
          continue;
        }
        const bool isAnechoic = target.tissue == "phantom_anechoic";
        const double radius = isAnechoic ? 0.8 : regionMm;
        const std::vector<float> inside = disc(masses, target.lateralMm, target.depthMm, radius);
        // Plain gel at the same depth.
        const std::vector<float> outside = disc(masses, isAnechoic ? 2.0 : -2.1, target.depthMm, radius);
        const double difference = (meanOf(inside) - meanOf(outside)) / seeds;
        const double apart = gcnrByThreshold(inside, outside) / seeds;
        if (isAnechoic)
        {
          anechoicDb += 0.5 * difference;
          anechoicGcnr += 0.5 * apart;
        }
        else
        {
          const auto real = std::find_if(std::begin(realMasses), std::end(realMasses),
                                         [&](const RealMass& mass) { return target.name == mass.name; });
          level[std::size_t(real - realMasses)] += difference;
          gcnr[std::size_t(real - realMasses)] += apart;
        }
      }
      deviation += deviationOf(disc(masses, 0.0, 21.0, regionMm)) / seeds;
      lateral += speckleMm(masses, false) / seeds;
      axial += speckleMm(masses, true) / seeds;
      if (seed == 1)
      {
        panels.push_back(pictureOf(masses));
        panels.push_back(pictureOf(wires));
      }
    }
    for (std::size_t n = 0; n < std::size(realMasses); ++n)
    {
      levelError += std::fabs(level[n] - realMasses[n].levelDb) / double(std::size(realMasses));
      gcnrError += std::fabs(gcnr[n] - realMasses[n].gcnr) / double(std::size(realMasses));
      rows.push_back({ realMasses[n].name + how, "level dB", number(realMasses[n].levelDb), number(level[n]) });
      rows.push_back({ realMasses[n].name + how, "gCNR", number(realMasses[n].gcnr), number(gcnr[n]) });
    }
    rows.push_back({ "anechoic" + how, "level dB", "-14", number(anechoicDb) });
    rows.push_back({ "anechoic" + how, "gCNR", "1", number(anechoicGcnr) });
    rows.push_back({ "speckle" + how, "SD dB", "2.2", number(deviation) });
    rows.push_back({ "speckle" + how, "lateral mm", "1.25", number(lateral) });
    rows.push_back({ "speckle" + how, "axial mm", "0.37", number(axial) });
    rows.push_back({ "wires" + how, "lateral mm", "0.61 to 0.76", number(wireWidth[0]) });
    rows.push_back({ "wires" + how, "axial mm", "0.44 to 0.79", number(wireWidth[1]) });
    output.figure("real_mass_level_error_db" + how, levelError, "dB");
    output.figure("real_mass_gcnr_error" + how, gcnrError, "1");
    output.figure("real_wire_width_error_mm" + how,
                  std::max(std::fabs(wireWidth[0] - 0.685), std::fabs(wireWidth[1] - 0.615)), "mm");
  }
  output.table("phantom_real.csv", { "target", "metric", "real", "here" }, rows);
  writePicture(montage(panels, 2), output.file("phantom_real.png"));
}

const Part part("phantom_real", run);

} // namespace
} // namespace sono::study
