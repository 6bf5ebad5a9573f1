// The phantom 040GSE as a real linear probe shows it, beside ours: level and gCNR of masses, width of wires, speckle.
// The real figures are of two pictures (ITKPOCUS, Apache-2.0).
#include "Detectability.h"
#include "NearTargets.h"
#include "PhantomImaging.h"
#include "Picture.h"
#include "Simulator.h"
#include "Study.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace sono::study {
namespace {

constexpr double rangeDb = 60.0;
/// What the picture's gel beside the masses has, 71 of 255, is so far above black by the bar on the screen.
constexpr double realGelDb = 20.5;

/// The scanner that is imitated, as far as its screen does not tell it: H 10 MHz, 40 mm, DR 60, focus 25 mm.
struct Scanner
{
  std::string name; ///< behind the figures'
  double bandwidth;
  int fans;
  double axialSmoothingMm;
  double lateralSmoothingMm;
  bool smoothCompressed;
};

// Of the last, bandwidth, smoothing and fans are chosen by the published speckle of plain gel: its axial and lateral
// size and its SD. That levels are smoothed, and not along the line, is what the wires say; nothing else was chosen.
// The one before is chosen in the same way by eight squares of that gel, see measureRealPictures. The others say what
// each setting is for.
const std::vector<Scanner> scanners{
  { "_without_smoothing", 0.4, 1, 0.0, 0.0, false },
  { "_smoothed_envelope", 0.4, 1, 0.2, 0.76, false },
  { "_smoothed_levels", 0.4, 1, 0.2, 0.76, true },
  { "_by_eight_squares", 0.2, 3, 0.0, 0.6, true },
  { "", 0.15, 2, 0.0, 0.84, true },
};

ImageSettings settingsOf(const Scanner& scanner, bool isQuick)
{
  // The elements, which the screen does not tell, are those of a common linear array.
  ProbePreset preset = readProbePreset(dataFile("probes/linear_l14.json"));
  preset.transmitFocusMm = 25.0;
  ImageSettings s;
  s.geometry = preset.geometry;
  s.geometry.depthMm = 40.0;
  s.geometry.lineCount = isQuick ? 64 : 256;
  s.geometry.compoundFans = scanner.fans;
  s.echo.imagingMode = ImagingMode::Harmonic;
  s.echo.centreFrequencyMHz = 10.0;
  s.echo.fractionalBandwidth = scanner.bandwidth;
  s.echo.depthMm = s.geometry.depthMm;
  s.echo.aperture = preset.aperture();
  s.echo.beam = BeamForm::Computed;
  s.bmode.dynamicRangeDb = rangeDb;
  s.bmode.tgcDbPerCm = 7.5; // evens out the gel's 0.5 dB/cm/MHz: 5 MHz on the way there, 10 MHz on the way back
  s.bmode.axialSmoothingMm = scanner.axialSmoothingMm;
  s.bmode.lateralSmoothingLines = scanner.lateralSmoothingMm * (s.geometry.lineCount - 1) / preset.geometry.widthMm;
  s.bmode.smoothCompressed = scanner.smoothCompressed;
  s.pixelMm = isQuick ? 0.15 : 0.05;
  s.matchStages();
  return s;
}

/// The phantom's scene, and what the wires are to the tracer.
class Bench
{
public:
  explicit Bench(bool isQuick)
    : isQuick_(isQuick)
  {
    phantom_.spacingMm = isQuick ? 1.0 : 0.25;
    phantom_.thicknessMm = 12.0;
    wires_.push_back(phantomWireSurface(targets, phantom_, bundledTissues()));
    simulator_ = std::make_unique<Simulator>(sceneOf(makeCalibrationPhantom(targets, phantom_)));
  }

  const std::vector<PhantomTarget> targets = readPhantomTargets(dataFile("phantom_040gse_near.csv"));

  /// With the gain that puts the gel where the real picture has it.
  ImageSettings settings(const Scanner& scanner) const
  {
    ImageSettings s = settingsOf(scanner, isQuick_);
    s.bmode.gainDb = realGelDb - gelAboveBlackDb(picture(s, 1, 1), rangeDb);
    return s;
  }

  /// Grey levels 0 to 1.
  PlaneImage picture(const ImageSettings& settings, int view, unsigned seed) const
  {
    ImageInput input;
    input.pose = phantomViewPose(phantom_, view);
    input.settings = settings;
    input.settings.echo.seed = seed;
    input.settings.tracing.seed = seed;
    input.targets = wires_;
    return simulator_->image(input).plane().host();
  }

private:
  bool isQuick_;
  CalibrationPhantomSettings phantom_;
  std::vector<TargetSurface> wires_;
  std::unique_ptr<Simulator> simulator_; ///< keeps the RF where display alone differs
};

/// What the real picture's masses have by the page that published these figures, each against gel of its choice, and by
/// nearFigures(), all against the same gel; grey levels are taken as linear over the range.
struct RealMass
{
  double makersDb;
  double publishedDb;
  double publishedGcnr;
  double sameGelDb;
  double sameGelGcnr;
};
const std::map<std::string, RealMass> realMasses{
  { "mass_m6", { -6.0, -7.1, 0.90, -7.55, 0.929 } },
  { "mass_m3", { -3.0, -3.0, 0.50, -3.47, 0.553 } },
  { "mass_p3", { 3.0, 2.0, 0.36, 3.14, 0.444 } },
};
constexpr double realSpeckleDb = 2.2;
constexpr double realWireLateralMm = 0.685; // middle of 0.61 to 0.76
constexpr double realWireAxialMm = 0.615;   // middle of 0.44 to 0.79

/// Rows of the table: one for each quantity, one column for each case.
class Table
{
public:
  void add(const std::string& name, const std::string& metric, const std::string& value)
  {
    const auto row =
      std::find_if(rows_.begin(), rows_.end(), [&](const auto& r) { return r[0] == name && r[1] == metric; });
    if (row != rows_.end())
    {
      row->push_back(value);
      return;
    }
    rows_.push_back({ name, metric, value });
  }

  void add(const NearFigures& figures)
  {
    for (const MassFigures& mass : figures.masses)
    {
      add(mass.name, "level dB", number(mass.levelDb));
      add(mass.name, "gCNR", number(mass.gcnr));
    }
    add("anechoic", "level dB", number(figures.anechoic.levelDb));
    add("anechoic", "gCNR", number(figures.anechoic.gcnr));
    add("speckle", "SD dB", number(figures.speckle.deviationDb));
    add("speckle", "lateral mm", number(figures.speckle.lateralMm));
    add("speckle", "axial mm", number(figures.speckle.axialMm));
    add("wires", "lateral mm", number(figures.wireLateralMm));
    add("wires", "axial mm", number(figures.wireAxialMm));
    add("wires", "peak to gel dB", number(figures.wirePeakDb));
  }

  void addPublished()
  {
    for (const char* name : { "mass_m6", "mass_m3", "mass_p3" })
    {
      add(name, "level dB", number(realMasses.at(name).publishedDb));
      add(name, "gCNR", number(realMasses.at(name).publishedGcnr));
    }
    add("anechoic", "level dB", "-14");
    add("anechoic", "gCNR", "1");
    add("speckle", "SD dB", number(realSpeckleDb));
    add("speckle", "lateral mm", "1.25");
    add("speckle", "axial mm", "0.37");
    add("wires", "lateral mm", "0.61 to 0.76");
    add("wires", "axial mm", "0.44 to 0.79");
    add("wires", "peak to gel dB", "");
  }

  const std::vector<std::vector<std::string>>& rows() const { return rows_; }

private:
  std::vector<std::vector<std::string>> rows_;
};

/// A real picture as it was published: 0.0291 mm a pixel, the probe's face at row 72, its middle at column 1041.
PlaneImage realPicture(const std::filesystem::path& path)
{
  constexpr double pixelMm = 0.0291;
  return readGrey(path, pixelMm, -1041.0 * pixelMm, -72.0 * pixelMm);
}

/// What the bar on the screen shows: the share of the range that a grey level stands for.
PlaneImage readByBar(PlaneImage image)
{
  const double bar[] = {
    0, 6, 14, 22, 34, 44, 58, 74, 91, 109, 127, 145, 165, 189, 215, 236, 249, 254, 255
  }; // each 0.05 of the bar's length, from black
  for (float& level : image.value)
  {
    const double grey = 255.0 * double(level);
    const std::size_t k = std::size_t(std::upper_bound(std::begin(bar) + 1, std::end(bar) - 1, grey) - std::begin(bar));
    level = float(0.05 * (double(k) - 1.0 + (grey - bar[k - 1]) / (bar[k] - bar[k - 1])));
  }
  return image;
}

/// The real pictures by the same functions, where the output's folder has them in `real`; they are no part of this
/// repository. Every square of gel and the levels read by the bar say how far the published figures can be relied on.
void measureRealPictures(Output& output, const std::vector<PhantomTarget>& targets)
{
  const auto massesFile = output.file("real/phantom_040gse_anechoic.png");
  const auto wiresFile = output.file("real/phantom_040gse_wires.png");
  if (!std::filesystem::exists(massesFile) || !std::filesystem::exists(wiresFile))
  {
    return;
  }
  const PlaneImage masses = realPicture(massesFile);
  const PlaneImage wires = realPicture(wiresFile);
  Table table;
  table.addPublished();
  for (const bool byBar : { false, true })
  {
    const auto read = [&](const PlaneImage& image) { return byBar ? readByBar(image) : image; };
    table.add(nearFigures(targets, read(masses), read(wires), rangeDb));
    // Squares of plain gel at the depth of the masses and of the wires, clear of all targets.
    GelSpeckle mean;
    const double places[][2] = { { -15.0, 24.0 }, { -10.0, 24.0 }, { -5.0, 24.0 }, { 0.0, 24.0 },
                                 { 5.0, 24.0 },   { 10.0, 24.0 },  { -2.4, 30.5 }, { 9.85, 30.5 } };
    for (const auto& place : places)
    {
      const GelSpeckle one = gelSpeckle(read(masses), rangeDb, place[0], place[1], 4.8);
      mean.deviationDb += one.deviationDb / double(std::size(places));
      mean.lateralMm += one.lateralMm / double(std::size(places));
      mean.axialMm += one.axialMm / double(std::size(places));
    }
    if (!byBar)
    {
      for (const char* metric : { "SD dB", "lateral mm", "axial mm" })
      {
        table.add("speckle of eight squares", metric, "");
      }
    }
    table.add("speckle of eight squares", "SD dB", number(mean.deviationDb));
    table.add("speckle of eight squares", "lateral mm", number(mean.lateralMm));
    table.add("speckle of eight squares", "axial mm", number(mean.axialMm));
  }
  output.table("phantom_real_pictures.csv", { "target", "metric", "published", "grey as linear", "grey by the bar" },
               table.rows());
}

/// What one speckle can do for the masses' gCNR where their levels are the maker's.
void printTheory(Output& output)
{
  std::vector<MeasuredLesion> published, sameGel;
  for (const auto& [name, mass] : realMasses)
  {
    published.push_back({ mass.publishedGcnr, mass.makersDb });
    sameGel.push_back({ mass.sameGelGcnr, mass.makersDb });
  }
  output.figure("real_mass_gcnr_error_theory_allows", leastGcnrErrorOfNormalLevels(published), "1");
  output.figure("real_mass_gcnr_error_theory_allows_looks", leastGcnrErrorOfLooks(published), "1");
  output.figure("real_mass_gcnr_error_theory_at_real_sd", gcnrErrorOfNormalLevels(published, realSpeckleDb), "1");
  output.figure("real_mass_gcnr_error_theory_allows_same_gel", leastGcnrErrorOfNormalLevels(sameGel), "1");
}

void run(Output& output)
{
  const Bench bench(output.quick());
  measureRealPictures(output, bench.targets);
  printTheory(output);
  Table table;
  std::vector<std::string> header{ "target", "metric", "real" };
  table.addPublished();
  std::vector<ImageSettings> settings;
  for (const Scanner& scanner : scanners)
  {
    settings.push_back(bench.settings(scanner));
  }
  std::vector<std::vector<NearFigures>> pictures(scanners.size());
  std::vector<Picture> panels;
  for (unsigned seed = 1; seed <= (output.quick() ? 1u : 6u); ++seed)
  {
    std::vector<PlaneImage> masses;
    for (const ImageSettings& s : settings)
    {
      masses.push_back(bench.picture(s, 1, seed));
    }
    for (std::size_t k = 0; k < scanners.size(); ++k)
    {
      const PlaneImage wires = bench.picture(settings[k], 2, seed);
      pictures[k].push_back(nearFigures(bench.targets, masses[k], wires, rangeDb));
      if (seed == 1 && (k == 0 || k + 1 == scanners.size()))
      {
        panels.push_back(pictureOf(masses[k]));
        panels.push_back(pictureOf(wires));
      }
    }
  }
  for (std::size_t k = 0; k < scanners.size(); ++k)
  {
    const std::string& name = scanners[k].name;
    const NearMean found = meanOf(pictures[k]);
    double levelError = 0.0, gcnrError = 0.0, sameGelLevelError = 0.0, sameGelGcnrError = 0.0, deviation = 0.0;
    const double share = 1.0 / double(found.mean.masses.size());
    for (std::size_t n = 0; n < found.mean.masses.size(); ++n)
    {
      const MassFigures& mass = found.mean.masses[n];
      const RealMass& real = realMasses.at(mass.name);
      levelError += share * std::fabs(mass.levelDb - real.publishedDb);
      gcnrError += share * std::fabs(mass.gcnr - real.publishedGcnr);
      sameGelLevelError += share * std::fabs(mass.levelDb - real.sameGelDb);
      sameGelGcnrError += share * std::fabs(mass.gcnr - real.sameGelGcnr);
      deviation += share * found.gcnrDeviation[n];
    }
    table.add(found.mean);
    header.push_back(name.empty() ? "here" : "here" + name);
    output.figure("real_mass_level_error_db" + name, levelError, "dB");
    output.figure("real_mass_gcnr_error" + name, gcnrError, "1");
    output.figure("real_mass_level_error_same_gel_db" + name, sameGelLevelError, "dB");
    output.figure("real_mass_gcnr_error_same_gel" + name, sameGelGcnrError, "1");
    output.figure("real_mass_gcnr_sd_of_one_picture" + name, deviation, "1");
    output.figure("real_wire_width_error_mm" + name,
                  std::max(std::fabs(found.mean.wireLateralMm - realWireLateralMm),
                           std::fabs(found.mean.wireAxialMm - realWireAxialMm)),
                  "mm");
  }
  output.table("phantom_real.csv", header, table.rows());
  writePicture(montage(panels, 2), output.file("phantom_real.png"));
}

const Part part("phantom_real", run);

} // namespace
} // namespace sono::study
