#pragma once

#include <string>
#include <vector>

namespace sono::study {

/// How a curve is drawn.
enum class CurveKind
{
  Line,
  Dots,
  Level ///< a dashed line across the plot at its first y
};

/// Points of one name. Without points a curve is not drawn, but the others look as if it were.
struct Curve
{
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
  CurveKind kind = CurveKind::Line;
};

struct PlotAxis
{
  std::string label;
  bool logarithmic = false;
};

/// A plot as an SVG element, 720 pixels wide and as high as its legend wants, with ticks, grid and a legend. No two of
/// 64 curves look alike: eight colours, then other marks and dashes. Points that are not finite, or not positive on a
/// logarithmic axis, are left out.
std::string svgPlot(const std::string& title, const PlotAxis& x, const PlotAxis& y, const std::vector<Curve>& curves);

} // namespace sono::study
