#include "NearTargets.h"

#include "Detectability.h"
#include "PhantomImaging.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sono::study {
namespace {

constexpr double massRadiusMm = 2.4;
constexpr double anechoicRadiusMm = 0.8;
constexpr double gelBesideMassesMm = -2.1; // lateral, between two of them
constexpr double gelBesideAnechoicMm = 2.0;
// Where the published figures of speckle come from: of all squares tried in the real picture this one gives them.
constexpr double gelLateralMm = -2.4;
constexpr double gelDepthMm = 30.5;
constexpr double gelSideMm = 4.8;

double meanOfValues(const std::vector<float>& values)
{
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

/// A square of levels in dB.
struct Square
{
  int side = 0;
  std::vector<double> db;

  double& at(int i, int j) { return db[std::size_t(j) * std::size_t(side) + std::size_t(i)]; }
  double at(int i, int j) const { return db[std::size_t(j) * std::size_t(side) + std::size_t(i)]; }

  /// Mean product of the levels `shift` pixels apart.
  double product(int shift, bool axial) const
  {
    double sum = 0.0;
    for (int j = 0; j < (axial ? side - shift : side); ++j)
    {
      for (int i = 0; i < (axial ? side : side - shift); ++i)
      {
        sum += at(i, j) * (axial ? at(i, j + shift) : at(i + shift, j));
      }
    }
    return sum / (double(side) * (side - shift));
  }

  /// Mean and slopes of the least squares are independent about the middle.
  void takePlaneOff()
  {
    double sum = 0.0, alongI = 0.0, alongJ = 0.0, squares = 0.0;
    const double middle = 0.5 * (side - 1);
    for (int j = 0; j < side; ++j)
    {
      for (int i = 0; i < side; ++i)
      {
        sum += at(i, j);
        alongI += (i - middle) * at(i, j);
        alongJ += (j - middle) * at(i, j);
        squares += (i - middle) * (i - middle);
      }
    }
    for (int j = 0; j < side; ++j)
    {
      for (int i = 0; i < side; ++i)
      {
        at(i, j) -= sum / double(db.size()) + ((i - middle) * alongI + (j - middle) * alongJ) / squares;
      }
    }
  }

  /// Twice the shift at which the autocorrelation falls to half, in pixels; NaN where it does not.
  double correlationWidth(bool axial) const
  {
    const double half = 0.5 * product(0, axial);
    double before = 2.0 * half;
    for (int shift = 1; shift < side / 2; ++shift)
    {
      const double here = product(shift, axial);
      if (here < half)
      {
        return 2.0 * (shift - 1 + (before - half) / (before - here));
      }
      before = here;
    }
    return NAN;
  }
};

float levelAt(const PlaneImage& image, int i, int j)
{
  return image.value[std::size_t(j) * std::size_t(image.width) + std::size_t(i)];
}

struct Peak
{
  int i = 0;
  int j = 0;
  float level = -1.0f;
};

Peak peakOf(const PlaneImage& image, const PhantomTarget& wire)
{
  Peak peak;
  for (int j = 0; j < image.height; ++j)
  {
    for (int i = 0; i < image.width; ++i)
    {
      const double x = image.lateralMinMm + i * image.pixelMm - wire.lateralMm;
      const double z = image.axialMinMm + j * image.pixelMm - wire.depthMm;
      if (std::hypot(x, z) < 0.7 && levelAt(image, i, j) > peak.level)
      {
        peak = { i, j, levelAt(image, i, j) };
      }
    }
  }
  return peak;
}

MassFigures massFigures(const PlaneImage& image, double rangeDb, const PhantomTarget& mass)
{
  const bool anechoic = mass.tissue == "phantom_anechoic";
  const double radius = anechoic ? anechoicRadiusMm : massRadiusMm;
  const std::vector<float> inside = valuesIn(image, mass.lateralMm, mass.depthMm, radius);
  const std::vector<float> outside =
    valuesIn(image, anechoic ? gelBesideAnechoicMm : gelBesideMassesMm, mass.depthMm, radius);
  return { mass.name, rangeDb * (meanOfValues(inside) - meanOfValues(outside)), gcnrByThreshold(inside, outside) };
}

} // namespace

GelSpeckle gelSpeckle(const PlaneImage& image, double rangeDb, double lateralMm, double depthMm, double sideMm)
{
  Square square{ int(sideMm / image.pixelMm), {} };
  const int left = int((lateralMm - 0.5 * sideMm - image.lateralMinMm) / image.pixelMm);
  const int top = int((depthMm - 0.5 * sideMm - image.axialMinMm) / image.pixelMm);
  for (int j = 0; j < square.side; ++j)
  {
    const float* row = image.value.data() + std::size_t(top + j) * std::size_t(image.width) + left;
    std::transform(row, row + square.side, std::back_inserter(square.db),
                   [&](float level) { return rangeDb * double(level); });
  }
  square.takePlaneOff();
  return { std::sqrt(square.product(0, true)), image.pixelMm * square.correlationWidth(false),
           image.pixelMm * square.correlationWidth(true) };
}

double wireWidthMm(const PlaneImage& image, double rangeDb, const PhantomTarget& wire, bool axial)
{
  const Peak peak = peakOf(image, wire);
  double width = 0.0;
  const float half = peak.level - float(6.0206 / rangeDb);
  for (const int way : { -1, 1 })
  {
    float before = peak.level;
    for (int k = 1; k < int(3.0 / image.pixelMm); ++k)
    {
      const float here = axial ? levelAt(image, peak.i, peak.j + way * k) : levelAt(image, peak.i + way * k, peak.j);
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

NearFigures nearFigures(const std::vector<PhantomTarget>& targets, const PlaneImage& masses, const PlaneImage& wires,
                        double rangeDb)
{
  NearFigures figures;
  double wireCount = 0.0, anechoicCount = 0.0;
  for (const PhantomTarget& target : targets)
  {
    if (target.kind == PhantomTargetKind::Wire)
    {
      figures.wireLateralMm += wireWidthMm(wires, rangeDb, target, false);
      figures.wireAxialMm += wireWidthMm(wires, rangeDb, target, true);
      figures.wirePeakDb += rangeDb * double(peakOf(wires, target).level);
      wireCount += 1.0;
      continue;
    }
    const MassFigures mass = massFigures(masses, rangeDb, target);
    if (target.tissue == "phantom_anechoic")
    {
      figures.anechoic.levelDb += mass.levelDb;
      figures.anechoic.gcnr += mass.gcnr;
      anechoicCount += 1.0;
    }
    else
    {
      figures.masses.push_back(mass);
    }
  }
  figures.wireLateralMm /= wireCount;
  figures.wireAxialMm /= wireCount;
  figures.wirePeakDb = figures.wirePeakDb / wireCount - gelAboveBlackDb(masses, rangeDb);
  figures.anechoic = { "anechoic", figures.anechoic.levelDb / anechoicCount, figures.anechoic.gcnr / anechoicCount };
  figures.speckle = gelSpeckle(masses, rangeDb, gelLateralMm, gelDepthMm, gelSideMm);
  return figures;
}

double gelAboveBlackDb(const PlaneImage& masses, double rangeDb)
{
  return rangeDb * meanOfValues(valuesIn(masses, gelBesideMassesMm, gelDepthMm, massRadiusMm));
}

NearMean meanOf(const std::vector<NearFigures>& pictures)
{
  const double share = 1.0 / double(pictures.size());
  NearMean result;
  NearFigures& mean = result.mean;
  mean.anechoic.name = "anechoic";
  for (const MassFigures& mass : pictures.front().masses)
  {
    mean.masses.push_back({ mass.name, 0.0, 0.0 });
  }
  for (const NearFigures& picture : pictures)
  {
    for (std::size_t n = 0; n < mean.masses.size(); ++n)
    {
      mean.masses[n].levelDb += share * picture.masses[n].levelDb;
      mean.masses[n].gcnr += share * picture.masses[n].gcnr;
    }
    mean.anechoic.levelDb += share * picture.anechoic.levelDb;
    mean.anechoic.gcnr += share * picture.anechoic.gcnr;
    mean.speckle.deviationDb += share * picture.speckle.deviationDb;
    mean.speckle.lateralMm += share * picture.speckle.lateralMm;
    mean.speckle.axialMm += share * picture.speckle.axialMm;
    mean.wireLateralMm += share * picture.wireLateralMm;
    mean.wireAxialMm += share * picture.wireAxialMm;
    mean.wirePeakDb += share * picture.wirePeakDb;
  }
  for (std::size_t n = 0; n < mean.masses.size(); ++n)
  {
    double squares = 0.0;
    for (const NearFigures& picture : pictures)
    {
      squares += std::pow(picture.masses[n].gcnr - mean.masses[n].gcnr, 2);
    }
    // One picture tells no spread.
    result.gcnrDeviation.push_back(pictures.size() > 1 ? std::sqrt(squares / double(pictures.size() - 1)) : 0.0);
  }
  return result;
}

} // namespace sono::study
