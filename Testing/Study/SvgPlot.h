#pragma once

#include <string>
#include <vector>

namespace sono::study {

/// Points of one name; joined by lines, or shown as dots.
struct Curve
{
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
  bool dots = false;
};

struct PlotAxis
{
  std::string label;
  bool logarithmic = false;
};

/// A plot as an SVG element of 640 x 340 pixels with ticks, grid and a legend. Points that are not finite, or not
/// positive on a logarithmic axis, are left out.
std::string svgPlot(const std::string& title, const PlotAxis& x, const PlotAxis& y, const std::vector<Curve>& curves);

/// Text as HTML holds it.
std::string escapedHtml(const std::string& text);

} // namespace sono::study
