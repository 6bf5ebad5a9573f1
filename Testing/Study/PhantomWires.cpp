// Target registration error of the wires, by view and group, for three ways to model a wire.
#include "PhantomWires.h"

#include "PhantomImaging.h"
#include "Study.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

namespace sono::study {
namespace {

constexpr double sameLineMm = 1.0; // wires that lie so near to a line are seen on it

/// Least squares parabola through (x, y); its vertex. A Gaussian peak is a parabola in dB.
double vertexOf(const std::vector<double>& x, const std::vector<double>& y)
{
  const double middle = std::accumulate(x.begin(), x.end(), 0.0) / double(x.size());
  double s[5] = {};
  double t[3] = {};
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    double power = 1.0;
    for (int p = 0; p < 5; ++p)
    {
      s[p] += power;
      t[std::min(p, 2)] += p < 3 ? power * y[i] : 0.0;
      power *= x[i] - middle;
    }
  }
  // Cramer's rule for a + b u + c u^2.
  const auto det = [](double a, double b, double c, double d, double e, double f, double g, double h, double i) {
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g);
  };
  const double whole = det(s[0], s[1], s[2], s[1], s[2], s[3], s[2], s[3], s[4]);
  const double b = det(s[0], t[0], s[2], s[1], t[1], s[3], s[2], t[2], s[4]) / whole;
  const double c = det(s[0], s[1], t[0], s[1], s[2], t[1], s[2], s[3], t[2]) / whole;
  return c < 0.0 ? middle - 0.5 * b / c : middle;
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
  // The pixels of the main lobe, at least three.
  std::size_t first = peak;
  std::size_t last = peak;
  while (first > 0 && (peak - first < 1 || profile.decibels[first - 1] > profile.decibels[peak] - 6.0))
  {
    --first;
  }
  while (last + 1 < profile.decibels.size() &&
         (last - peak < 1 || profile.decibels[last + 1] > profile.decibels[peak] - 6.0))
  {
    ++last;
  }
  const auto part = [&](const std::vector<double>& v) {
    return std::vector<double>(v.begin() + std::ptrdiff_t(first), v.begin() + std::ptrdiff_t(last) + 1);
  };
  place.pixelMm = profile.placeMm[peak];
  place.fittedMm = vertexOf(part(profile.placeMm), part(profile.decibels));
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
    const PlaneImage decibels = decibelImage(imaging, bench.image(imaging, view, seed));
    for (const PhantomTarget& target : bench.targets())
    {
      if (target.view == view && target.kind == PhantomTargetKind::Wire)
      {
        errors.wires.push_back({ target, locateWire(decibels, target, windowOf(bench, target)) });
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
