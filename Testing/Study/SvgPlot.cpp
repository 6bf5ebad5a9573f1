#include "SvgPlot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace sono::study {
namespace {

constexpr double width = 640.0;
constexpr double height = 340.0;
constexpr double left = 70.0;
constexpr double right = 230.0; // the legend's
constexpr double top = 30.0;
constexpr double bottom = 50.0;
constexpr std::array<const char*, 8> colours{ "#1f5fa8", "#c8501e", "#3a8a3a", "#8a3a9a",
                                              "#b09000", "#208a8a", "#c03060", "#555555" };

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
      if (good(curve.x[i], x) && good(curve.y[i], y))
      {
        values.push_back(ofX ? curve.x[i] : curve.y[i]);
      }
    }
  }
  return values;
}

void drawFrame(std::ostream& svg, const std::string& title, const PlotAxis& x, const PlotAxis& y, const Scale& across,
               const Scale& up)
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

void drawCurve(std::ostream& svg, const Curve& curve, const char* colour, const Scale& across, const Scale& up)
{
  std::ostringstream points;
  for (std::size_t i = 0; i < curve.x.size(); ++i)
  {
    if (!across.shows(curve.x[i]) || !up.shows(curve.y[i]))
    {
      continue;
    }
    const double px = across.pixel(curve.x[i]);
    const double py = up.pixel(curve.y[i]);
    points << px << ',' << py << ' ';
    if (curve.dots)
    {
      svg << "<circle cx='" << px << "' cy='" << py << "' r='3.5' fill='" << colour << "'/>\n";
    }
  }
  if (!curve.dots)
  {
    svg << "<polyline fill='none' stroke='" << colour << "' stroke-width='1.6' points='" << points.str() << "'/>\n";
  }
}

} // namespace

std::string escapedHtml(const std::string& text)
{
  std::string out;
  for (const char c : text)
  {
    out += c == '&'   ? std::string("&amp;")
           : c == '<' ? std::string("&lt;")
           : c == '>' ? std::string("&gt;")
                      : std::string(1, c);
  }
  return out;
}

std::string svgPlot(const std::string& title, const PlotAxis& x, const PlotAxis& y, const std::vector<Curve>& curves)
{
  const Scale across(x, shownValues(curves, x, y, true), left, width - right);
  const Scale up(y, shownValues(curves, x, y, false), height - bottom, top);
  std::ostringstream svg;
  svg << "<svg xmlns='http://www.w3.org/2000/svg' width='" << width << "' height='" << height
      << "' font-family='sans-serif' font-size='11'>\n";
  drawFrame(svg, title, x, y, across, up);
  for (std::size_t i = 0; i < curves.size(); ++i)
  {
    const char* colour = colours[i % colours.size()];
    drawCurve(svg, curves[i], colour, across, up);
    const double row = top + 12.0 + 15.0 * double(i);
    svg << "<rect x='" << width - right + 10 << "' y='" << row - 8 << "' width='10' height='8' fill='" << colour
        << "'/><text x='" << width - right + 25 << "' y='" << row << "'>" << escapedHtml(curves[i].name) << "</text>\n";
  }
  svg << "</svg>\n";
  return svg.str();
}

} // namespace sono::study
