// Target registration error of the wires, by view and group, for three ways to model a wire.
#include "PhantomWires.h"

#include "PhantomImaging.h"
#include "Study.h"
#include "WireRange.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace sono::study {
namespace {

constexpr double sameLineMm = 1.0; // wires that lie so near to a line are seen on it

// What of an image belongs to a wire's echo.
constexpr double rowsReachMm = 1.0;
constexpr double columnsReachMm = 3.0;

/// A paraboloid over (x, z) by least squares: 1, x, z, x^2, x z, z^2.
class Paraboloid
{
public:
  void add(double x, double z, double value)
  {
    const std::array<double, 7> row{ 1.0, x, z, x * x, x * z, z * z, value };
    for (std::size_t i = 0; i < 6; ++i)
    {
      for (std::size_t j = 0; j < 7; ++j)
      {
        equations_[i][j] += row[i] * row[j];
      }
    }
  }
  /// Where it is highest; nothing where it has no such place.
  std::optional<Vec2d> vertex() const
  {
    const std::array<double, 6> c = solved();
    const double determinant = 4.0 * c[3] * c[5] - c[4] * c[4];
    if (!(c[3] < 0.0 && determinant > 0.0))
    {
      return std::nullopt;
    }
    return Vec2d(c[4] * c[2] - 2.0 * c[5] * c[1], c[4] * c[1] - 2.0 * c[3] * c[2]) / determinant;
  }

private:
  /// By elimination with pivots.
  std::array<double, 6> solved() const
  {
    auto e = equations_;
    for (std::size_t i = 0; i < 6; ++i)
    {
      const auto largest =
        std::max_element(e.begin() + std::ptrdiff_t(i), e.end(),
                         [i](const auto& one, const auto& other) { return std::fabs(one[i]) < std::fabs(other[i]); });
      std::swap(e[i], *largest);
      for (std::size_t k = 0; k < 6; ++k)
      {
        const double share = k == i ? 0.0 : e[k][i] / e[i][i];
        for (std::size_t j = i; j < 7; ++j)
        {
          e[k][j] -= share * e[i][j];
        }
      }
    }
    std::array<double, 6> c;
    for (std::size_t i = 0; i < 6; ++i)
    {
      c[i] = e[i][6] / e[i][i];
    }
    return c;
  }

  std::array<std::array<double, 7>, 6> equations_{};
};

/// Where in the image an echo is highest: the vertex of the paraboloid through the pixels of its main lobe (-6 dB) in
/// dB, since a Gaussian pulse under a Gaussian beam is one. Of an echo that is none, as the two faces of a column of
/// voxels, the vertex may lie far beside it: then the brightest pixel counts.
Vec2d placeOf(const PlaneImage& image, const Vec2d& peak)
{
  const double peakDb = valueAt(image, peak.x, peak.y);
  const int rows = int(rowsReachMm / image.pixelMm);
  const int columns = int(columnsReachMm / image.pixelMm);
  Paraboloid echo;
  for (int j = -rows; j <= rows; ++j)
  {
    for (int i = -columns; i <= columns; ++i)
    {
      const Vec2d off(i * image.pixelMm, j * image.pixelMm);
      const double db = valueAt(image, peak.x + off.x, peak.y + off.y) - peakDb;
      if (db > -6.0)
      {
        echo.add(off.x, off.y, db);
      }
    }
  }
  const Vec2d vertex = echo.vertex().value_or(Vec2d(0.0));
  const bool isWithin = std::fabs(vertex.x) < columnsReachMm && std::fabs(vertex.y) < rowsReachMm;
  return isWithin ? peak + vertex : peak;
}

/// Pixels along the expected line around a wire.
struct Profile
{
  std::vector<double> placeMm;
  std::vector<double> decibels;
};

Profile profileAt(const PlaneImage& image, const PhantomTarget& wire, bool vertical, const WireWindow& window)
{
  Profile profile;
  const double expected = vertical ? wire.depthMm : wire.lateralMm;
  const double first = vertical ? image.axialMinMm : image.lateralMinMm;
  const int low = int(std::ceil((expected - window.beforeMm - first) / image.pixelMm));
  const int high = int(std::floor((expected + window.behindMm - first) / image.pixelMm));
  for (int i = low; i <= high; ++i)
  {
    const double place = first + i * image.pixelMm;
    const double value =
      vertical ? valueAt(image, wire.lateralMm, place + 1e-9) : valueAt(image, place + 1e-9, wire.depthMm);
    if (std::isfinite(value))
    {
      profile.placeMm.push_back(place);
      profile.decibels.push_back(value);
    }
  }
  return profile;
}

/// Brightest pixel beside the one on the expected line.
Vec2d brightestNear(const PlaneImage& image, const PhantomTarget& wire, double placeMm)
{
  const bool vertical = wire.name == "vertical";
  const Vec2d onLine(vertical ? wire.lateralMm : placeMm, vertical ? placeMm : wire.depthMm);
  const Vec2d across = vertical ? Vec2d(1.0, 0.0) : Vec2d(0.0, 1.0);
  const int reach = int((vertical ? columnsReachMm : rowsReachMm) / image.pixelMm);
  Vec2d brightest = onLine;
  for (int i = -reach; i <= reach; ++i)
  {
    const Vec2d place = onLine + across * (i * image.pixelMm);
    if (valueAt(image, place.x, place.y) > valueAt(image, brightest.x, brightest.y))
    {
      brightest = place;
    }
  }
  return brightest;
}

/// Not beyond half way to the next wire on the line, of whatever group or view.
WireWindow windowOf(const PhantomBench& bench, const PhantomTarget& wire)
{
  const Vec3d centre = phantomTargetCentreMm(bench.settings(), wire);
  const int along = wire.name == "vertical" ? 2 : 0;
  WireWindow window;
  for (const PhantomTarget& other : bench.targets())
  {
    const Vec3d off = phantomTargetCentreMm(bench.settings(), other) - centre;
    if (other.kind == PhantomTargetKind::Wire && std::fabs(off[2 - along]) < sameLineMm)
    {
      window.beforeMm = off[along] < 0.0 ? std::min(window.beforeMm, -0.5 * off[along]) : window.beforeMm;
      window.behindMm = off[along] > 0.0 ? std::min(window.behindMm, 0.5 * off[along]) : window.behindMm;
    }
  }
  return window;
}

} // namespace

WirePlace locateWire(const PlaneImage& decibels, const PhantomTarget& wire, const WireWindow& window)
{
  const bool vertical = wire.name == "vertical";
  const Profile profile = profileAt(decibels, wire, vertical, window);
  WirePlace place;
  place.expectedMm = vertical ? wire.depthMm : wire.lateralMm;
  if (profile.decibels.size() < 5)
  {
    return place;
  }
  const std::size_t peak =
    std::size_t(std::max_element(profile.decibels.begin(), profile.decibels.end()) - profile.decibels.begin());
  std::vector<double> sorted = profile.decibels;
  std::nth_element(sorted.begin(), sorted.begin() + std::ptrdiff_t(sorted.size() / 2), sorted.end());
  place.aboveMedianDb = profile.decibels[peak] - sorted[sorted.size() / 2];
  place.found = place.aboveMedianDb > 10.0 && peak > 0 && peak + 1 < profile.decibels.size();
  place.pixelMm = profile.placeMm[peak];
  const Vec2d fitted = placeOf(decibels, brightestNear(decibels, wire, place.pixelMm));
  place.fittedMm = vertical ? fitted.y : fitted.x;
  return place;
}

PhantomImaging imagingOf(WireModel wires, int lines)
{
  PhantomImaging imaging = phantomImaging(lines);
  if (wires == WireModel::Surface)
  {
    imaging.echo.arrayField = std::make_shared<ArrayField>(phantomAperture(), imaging.echo.depthMm);
    imaging.echo.field = nullptr;
  }
  return imaging;
}

WireErrors measureWires(const PhantomBench& bench, const PhantomImaging& imaging, unsigned seed)
{
  WireErrors errors;
  for (int view = 1; view <= phantomViewCount; ++view)
  {
    const RfLines rf = bench.image(imaging, view, seed);
    const PlaneImage decibels = decibelImage(imaging, rf);
    PhantomImaging fine = imaging; // a pulse is as long as a pixel is wide
    fine.pixelMm *= 0.25;
    const PlaneImage fineDecibels = decibelImage(fine, rf);
    for (const PhantomTarget& target : bench.targets())
    {
      if (target.view == view && target.kind == PhantomTargetKind::Wire)
      {
        const WireWindow window = windowOf(bench, target);
        WirePlace place = locateWire(decibels, target, window);
        place.fittedMm = locateWire(fineDecibels, target, window).fittedMm;
        errors.wires.push_back({ target, place });
      }
    }
  }
  return errors;
}

Spread WireErrors::spread(int view, const std::string& group, bool fitted) const
{
  std::vector<double> values;
  for (const auto& [target, place] : wires)
  {
    if (place.found && (view == 0 || target.view == view) && (group.empty() || target.name == group))
    {
      values.push_back(std::fabs((fitted ? place.fittedMm : place.pixelMm) - place.expectedMm));
    }
  }
  Spread spread;
  spread.count = int(values.size());
  if (values.empty())
  {
    return spread;
  }
  spread.mean = std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
  for (const double v : values)
  {
    spread.deviation += (v - spread.mean) * (v - spread.mean) / double(values.size());
  }
  spread.deviation = std::sqrt(spread.deviation);
  return spread;
}

namespace {

/// What the seed's table 3 has for views 1 to 3 of a group.
const std::map<std::string, std::vector<std::string>> seedErrors{
  { "vertical", { "0.03 +- 0.03", "0.09 +- 0.07", "0.12 +- 0.09" } },
  { "near", { "0.05 +- 0.04", "0.16 +- 0.14", "0.28 +- 0.05" } },
  { "far", { "0.34 +- 0.33", "0.25 +- 0.59", "0.33 +- 0.37" } },
};

std::string plusMinus(const Spread& spread)
{
  char text[64];
  std::snprintf(text, sizeof text, "%.3f +- %.3f", spread.mean, spread.deviation);
  return text;
}

/// What an exact echo of the vertical group would be off by: the lens and the wire's thickness turn its phase.
void tellDirectSums(Output& output, const std::vector<PhantomTarget>& targets)
{
  const ArrayAperture aperture = phantomAperture();
  const double attenuation = bundledTissues().find("phantom_gel")->attenuationDbPerCmMHz;
  std::vector<std::vector<std::string>> rows;
  double sum = 0.0;
  for (const PhantomTarget& wire : targets)
  {
    if (wire.name == "vertical" && wire.view == 1)
    {
      const double shift = wireRangeShiftMm(aperture, wire.depthMm, wire.diameterMm, attenuation);
      rows.push_back(
        { number(wire.depthMm), number(shift), number(wireRangeShiftMm(aperture, wire.depthMm, 0.0, attenuation)) });
      sum += std::fabs(shift);
    }
  }
  output.figure("tre_vertical_direct_sum_mm", sum / double(rows.size()), "mm");
  output.table("phantom_wire_ranges.csv", { "depth mm", "wire's range less depth mm", "a point's mm" }, rows);
}

void run(Output& output)
{
  struct Case
  {
    const char* name;
    WireModel model;
    int lines;
  };
  const std::vector<Case> cases{ { "Embree targets", WireModel::Surface, 256 },
                                 { "Embree targets", WireModel::Surface, 128 },
                                 { "lines of scatterers", WireModel::Scatterers, 256 },
                                 { "lines of scatterers", WireModel::Scatterers, 128 },
                                 { "voxels of 0.5 mm", WireModel::Voxels, 256 } };
  tellDirectSums(output, readPhantomTargets(dataFile("phantom_040gse.csv")));
  std::vector<std::vector<std::string>> models;
  std::vector<std::vector<std::string>> places;
  for (const Case& c : cases)
  {
    const PhantomBench bench(c.model, output.quick() ? 2.0 : 0.5);
    const PhantomImaging imaging = imagingOf(c.model, output.quick() ? 48 : c.lines);
    const WireErrors errors = measureWires(bench, imaging, 1);
    const Spread all = errors.spread(0, "", true);
    models.push_back({ c.name, std::to_string(c.lines),
                       std::to_string(all.count) + " of " + std::to_string(errors.wires.size()), plusMinus(all),
                       plusMinus(errors.spread(0, "", false)) });
    if (&c != &cases.front())
    {
      continue;
    }
    std::vector<std::vector<std::string>> groups;
    for (const auto& [group, ofSeed] : seedErrors)
    {
      for (int view = 1; view <= phantomViewCount; ++view)
      {
        groups.push_back({ group, std::to_string(view), std::to_string(errors.spread(view, group, true).count),
                           plusMinus(errors.spread(view, group, true)), plusMinus(errors.spread(view, group, false)),
                           ofSeed[std::size_t(view - 1)] });
      }
    }
    output.table("phantom_tre.csv", { "group", "view", "wires", "TRE mm", "TRE of the brightest pixel mm", "seed mm" },
                 groups);
    for (const auto& [target, place] : errors.wires)
    {
      places.push_back({ target.name, std::to_string(target.view), number(target.lateralMm), number(target.depthMm),
                         place.found ? number(place.fittedMm - place.expectedMm) : "not found",
                         number(place.aboveMedianDb) });
    }
    output.figure("tre_mean_mm", all.mean, "mm");
    output.figure("tre_std_mm", all.deviation, "mm");
    output.figure("tre_wires_found", all.count, "wires");
    output.figure("tre_pixel_mean_mm", errors.spread(0, "", false).mean, "mm");
  }
  output.table("phantom_wire_models.csv",
               { "wires as", "scan lines", "found", "TRE mm", "TRE of the brightest pixel mm" }, models);
  output.table("phantom_wires.csv", { "group", "view", "lateral mm", "depth mm", "error mm", "above the median dB" },
               places);
}

const Part part("phantom_wires", run);

} // namespace
} // namespace sono::study
