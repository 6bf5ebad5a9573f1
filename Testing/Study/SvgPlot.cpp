#include "SvgPlot.h"

#include "Html.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <sstream>
#include <utility>

namespace sono::study {
namespace {

constexpr double width = 720.0;
constexpr double leastHeight = 340.0;
constexpr double left = 70.0;
constexpr double right = 300.0; // the legend's
constexpr double top = 30.0;
constexpr double bottom = 50.0;
constexpr std::array<const char*, 8> colours{ "#1f5fa8", "#c8501e", "#3a8a3a", "#8a3a9a",
                                              "#b09000", "#208a8a", "#c03060", "#555555" };
constexpr std::array<const char*, 8> dashes{ "none", "6 3", "2 2", "8 3 2 3", "12 3", "1 3", "4 2 1 2", "10 2 2 2" };

/// A mark of one of eight shapes around a place.
void drawMark(std::ostream& svg, double x, double y, const char* colour, std::size_t shape)
{
  const auto polygon = [&](std::initializer_list<std::pair<double, double>> corners) {
    svg << "<polygon class='mark' fill='" << colour << "' points='";
    for (const auto& [dx, dy] : corners)
    {
      svg << x + dx << ',' << y + dy << ' ';
    }
    svg << "'/>\n";
  };
  const auto strokes = [&](const char* path) {
    svg << "<path class='mark' fill='none' stroke-width='1.6' stroke='" << colour << "' transform='translate(" << x
        << ' ' << y << ")' d='" << path << "'/>\n";
  };
  switch (shape % 8)
  {
    case 0:
      svg << "<circle class='mark' cx='" << x << "' cy='" << y << "' r='3' fill='" << colour << "'/>\n";
      break;
    case 1:
      polygon({ { -3, -3 }, { 3, -3 }, { 3, 3 }, { -3, 3 } });
      break;
    case 2:
      polygon({ { 0, -4 }, { 3.6, 3 }, { -3.6, 3 } });
      break;
    case 3:
      polygon({ { 0, -4.2 }, { 4.2, 0 }, { 0, 4.2 }, { -4.2, 0 } });
      break;
    case 4:
      strokes("M-3 -3L3 3M-3 3L3 -3");
      break;
    case 5:
      strokes("M0 -4V4M-4 0H4");
      break;
    case 6:
      svg << "<circle class='mark' cx='" << x << "' cy='" << y << "' r='3' fill='white' stroke-width='1.4' stroke='"
          << colour << "'/>\n";
      break;
    default:
      polygon({ { 0, 4 }, { 3.6, -3 }, { -3.6, -3 } });
  }
}

/// One axis: from values to pixels.
class Scale
{
public:
  Scale(const PlotAxis& axis, const std::vector<double>& values, double from, double to)
    : logarithmic_(axis.logarithmic)
    , from_(from)
    , to_(to)
  {
    low_ = 1e300;
    high_ = -1e300;
    for (const double v : values)
    {
      low_ = std::min(low_, mapped(v));
      high_ = std::max(high_, mapped(v));
    }
    if (values.empty())
    {
      low_ = 0.0;
      high_ = 1.0;
    }
    const double margin = high_ > low_ ? 0.04 * (high_ - low_) : 0.5;
    low_ -= margin;
    high_ += margin;
  }

  bool shows(double value) const { return std::isfinite(value) && (!logarithmic_ || value > 0.0); }
  double pixel(double value) const { return from_ + (mapped(value) - low_) / (high_ - low_) * (to_ - from_); }

  std::vector<double> ticks() const
  {
    std::vector<double> ticks;
    if (logarithmic_)
    {
      const int every = std::max(1, int((high_ - low_) / 6.0));
      for (int e = int(std::ceil(low_)); e <= high_; e += every)
      {
        ticks.push_back(std::pow(10.0, e));
      }
      if (ticks.size() > 1)
      {
        return ticks;
      }
      return { std::pow(10.0, low_), std::pow(10.0, 0.5 * (low_ + high_)), std::pow(10.0, high_) };
    }
    const double rough = (high_ - low_) / 6.0;
    const double decade = std::pow(10.0, std::floor(std::log10(rough)));
    const double step = decade * (rough / decade < 2.0 ? 2.0 : rough / decade < 5.0 ? 5.0 : 10.0);
    for (double t = std::ceil(low_ / step) * step; t <= high_; t += step)
    {
      ticks.push_back(std::fabs(t) < 1e-9 * step ? 0.0 : t);
    }
    return ticks;
  }

private:
  double mapped(double value) const { return logarithmic_ ? std::log10(value) : value; }

  bool logarithmic_;
  double from_;
  double to_;
  double low_;
  double high_;
};

std::string tickText(double value)
{
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// The values of an axis that can be shown.
std::vector<double> shownValues(const std::vector<Curve>& curves, const PlotAxis& x, const PlotAxis& y, bool ofX)
{
  std::vector<double> values;
  const auto good = [](double v, const PlotAxis& axis) { return std::isfinite(v) && (!axis.logarithmic || v > 0.0); };
  for (const Curve& curve : curves)
  {
    for (std::size_t i = 0; i < curve.x.size(); ++i)
    {
      const bool level = curve.kind == CurveKind::Level; // everywhere, and nowhere in particular
      if (good(curve.y[i], y) && (level ? !ofX : good(curve.x[i], x)))
      {
        values.push_back(ofX ? curve.x[i] : curve.y[i]);
      }
    }
  }
  return values;
}

void drawFrame(std::ostream& svg, const std::string& title, const PlotAxis& x, const PlotAxis& y, const Scale& across,
               const Scale& up, double height)
{
  svg << "<text x='" << left << "' y='18' font-weight='bold'>" << escapedHtml(title) << "</text>\n";
  for (const double t : across.ticks())
  {
    const double p = across.pixel(t);
    svg << "<line x1='" << p << "' y1='" << top << "' x2='" << p << "' y2='" << height - bottom
        << "' stroke='#ddd'/><text x='" << p << "' y='" << height - bottom + 16 << "' text-anchor='middle'>"
        << tickText(t) << "</text>\n";
  }
  for (const double t : up.ticks())
  {
    const double p = up.pixel(t);
    svg << "<line x1='" << left << "' y1='" << p << "' x2='" << width - right << "' y2='" << p
        << "' stroke='#ddd'/><text x='" << left - 6 << "' y='" << p + 4 << "' text-anchor='end'>" << tickText(t)
        << "</text>\n";
  }
  svg << "<rect x='" << left << "' y='" << top << "' width='" << width - left - right << "' height='"
      << height - top - bottom << "' fill='none' stroke='#888'/>\n";
  svg << "<text x='" << 0.5 * (left + width - right) << "' y='" << height - 14 << "' text-anchor='middle'>"
      << escapedHtml(x.label) << "</text>\n";
  svg << "<text transform='translate(16 " << 0.5 * (top + height - bottom) << ") rotate(-90)' text-anchor='middle'>"
      << escapedHtml(y.label) << "</text>\n";
}

/// What tells one curve from the others: neighbours differ in colour and mark, those of one colour in all else.
struct Look
{
  const char* colour;
  const char* dash;
  std::size_t mark;
};

Look lookOf(std::size_t index)
{
  return { colours[index % colours.size()], dashes[index / colours.size() % dashes.size()],
           index + index / colours.size() };
}

void drawLine(std::ostream& svg, const std::string& points, const Look& look)
{
  svg << "<polyline fill='none' stroke='" << look.colour << "' stroke-width='1.4' stroke-dasharray='" << look.dash
      << "' points='" << points << "'/>\n";
}

void drawCurve(std::ostream& svg, const Curve& curve, const Look& look, const Scale& across, const Scale& up)
{
  if (curve.kind == CurveKind::Level)
  {
    std::ostringstream ends;
    const double y = curve.y.empty() || !up.shows(curve.y[0]) ? -1.0 : up.pixel(curve.y[0]);
    ends << left << ',' << y << ' ' << width - right << ',' << y;
    if (y >= 0.0)
    {
      drawLine(svg, ends.str(), look);
    }
    return;
  }
  std::vector<std::pair<double, double>> places;
  std::ostringstream points;
  for (std::size_t i = 0; i < curve.x.size(); ++i)
  {
    if (across.shows(curve.x[i]) && up.shows(curve.y[i]))
    {
      places.emplace_back(across.pixel(curve.x[i]), up.pixel(curve.y[i]));
      points << places.back().first << ',' << places.back().second << ' ';
    }
  }
  if (curve.kind == CurveKind::Line)
  {
    drawLine(svg, points.str(), look);
  }
  // Marks on a finely drawn line would hide it.
  for (std::size_t i = 0; i < places.size() && (curve.kind == CurveKind::Dots || places.size() <= 24); ++i)
  {
    drawMark(svg, places[i].first, places[i].second, look.colour, look.mark);
  }
}

} // namespace

std::string svgPlot(const std::string& title, const PlotAxis& x, const PlotAxis& y, const std::vector<Curve>& curves)
{
  const double height = std::max(leastHeight, top + bottom + 15.0 * double(curves.size()));
  const Scale across(x, shownValues(curves, x, y, true), left, width - right);
  const Scale up(y, shownValues(curves, x, y, false), height - bottom, top);
  std::ostringstream svg;
  svg << "<svg xmlns='http://www.w3.org/2000/svg' width='" << width << "' height='" << height
      << "' font-family='sans-serif' font-size='11'>\n";
  drawFrame(svg, title, x, y, across, up, height);
  double row = top - 3.0;
  for (std::size_t i = 0; i < curves.size(); ++i)
  {
    if (curves[i].y.empty())
    {
      continue;
    }
    const Look look = curves[i].kind == CurveKind::Level ? Look{ "#222222", "7 4", 0 } : lookOf(i);
    drawCurve(svg, curves[i], look, across, up);
    row += 15.0;
    const double from = width - right + 8.0;
    if (curves[i].kind != CurveKind::Dots)
    {
      std::ostringstream ends;
      ends << from << ',' << row - 4.0 << ' ' << from + 24.0 << ',' << row - 4.0;
      drawLine(svg, ends.str(), look);
    }
    if (curves[i].kind != CurveKind::Level)
    {
      drawMark(svg, from + 12.0, row - 4.0, look.colour, look.mark);
    }
    svg << "<text x='" << from + 30.0 << "' y='" << row << "'>" << escapedHtml(curves[i].name) << "</text>\n";
  }
  svg << "</svg>\n";
  return svg.str();
}

} // namespace sono::study
