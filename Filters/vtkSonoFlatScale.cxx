#include "vtkSonoFlatScale.h"

#include "SameSettings.h"
#include "SonoFlatDrawing.h"
#include "SonoProbeField.h"
#include "SonoStage.h"

#include "vtkDataSet.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <string>

vtkStandardNewMacro(vtkSonoFlatScale);

namespace {

enum Part
{
  RULER = 0,
  MARKER = 1,
  LATERAL_RULER = 2,
  GREY_BAR = 3
};

using sono::FlatDrawing;
using Align = FlatDrawing::Align;
constexpr FlatDrawing::Color lightGrey{ 217, 217, 217 };

/// Half the lateral width of a polyline of the outline.
double halfWidthMm(const std::vector<sono::Vec3d>& polyline)
{
  double widest = 0.0;
  for (const sono::Vec3d& p : polyline)
  {
    widest = std::max(widest, std::abs(p.x));
  }
  return widest;
}

/// How far the border reaches to the right where its depth is at most so far from the face's.
double widthNearFaceMm(const std::vector<sono::Vec3d>& border, double nearMm)
{
  double widest = 0.0;
  for (std::size_t i = 1; i < border.size(); ++i)
  {
    const sono::Vec3d& a = border[i - 1];
    const sono::Vec3d& b = border[i];
    // The part of the stroke between the two depths, from share `from` to share `to` of it.
    const double step = b.z - a.z;
    double from = 0.0;
    double to = 1.0;
    if (step != 0.0)
    {
      const auto [first, last] = std::minmax({ (-nearMm - a.z) / step, (nearMm - a.z) / step });
      from = std::max(from, first);
      to = std::min(to, last);
    }
    else if (std::abs(a.z) > nearMm)
    {
      continue;
    }
    if (from <= to)
    {
      widest = std::max({ widest, a.x + from * (b.x - a.x), a.x + to * (b.x - a.x) });
    }
  }
  return widest;
}

/// What a picture's rulers and bar have in common, in mm.
struct Measures
{
  explicit Measures(const sono::ScanGeometry& geometry)
    : depth(geometry.depthMm)
    , face(geometry.lineOrigin() == sono::LineOrigin::Catheter ? geometry.radiusMm : 0.0)
    , bottom(sono::planeExtent(geometry).axialMaxMm)
    , numberedCm(depth < 80.0 ? 1 : 5)
  {
  }

  double longTick() const { return 0.03 * depth; }
  double shortTick() const { return 0.015 * depth; }
  double digit() const { return 0.05 * depth; }

  double depth;
  double face;
  double bottom;
  int numberedCm;
};

constexpr double rounding = 1e-9;

void drawDepth(const Measures& mm, double halfWidthMm, FlatDrawing& drawing)
{
  drawing.setPart(RULER);
  const double rulerMm = -halfWidthMm - 0.03 * mm.depth;
  drawing.stroke(rulerMm, mm.face, rulerMm, mm.face + mm.depth);
  for (int cm = 0; cm <= std::floor(mm.depth / 10.0 + rounding); ++cm)
  {
    const bool isNumbered = cm % mm.numberedCm == 0;
    const double yMm = mm.face + 10.0 * cm;
    const double tickMm = rulerMm - (isNumbered ? mm.longTick() : mm.shortTick());
    drawing.stroke(rulerMm, yMm, tickMm, yMm);
    if (isNumbered)
    {
      drawing.text(std::to_string(cm) + (cm == 0 ? " cm" : ""), tickMm - mm.shortTick(), yMm, mm.digit(), Align::Right);
    }
  }
}

/// Below the picture, from its middle.
void drawLateral(const Measures& mm, double halfWidthMm, FlatDrawing& drawing)
{
  drawing.setPart(LATERAL_RULER);
  const double rulerMm = mm.bottom + 0.03 * mm.depth;
  drawing.stroke(-halfWidthMm, rulerMm, halfWidthMm, rulerMm);
  const int lastCm = int(std::floor(halfWidthMm / 10.0 + rounding));
  for (int cm = -lastCm; cm <= lastCm; ++cm)
  {
    const bool isNumbered = cm % mm.numberedCm == 0;
    const double tickMm = rulerMm + (isNumbered ? mm.longTick() : mm.shortTick());
    drawing.stroke(10.0 * cm, rulerMm, 10.0 * cm, tickMm);
    if (isNumbered)
    {
      drawing.text(std::to_string(cm), 10.0 * cm, tickMm + 0.5 * mm.digit() + mm.shortTick(), mm.digit(),
                   Align::Centre);
    }
  }
}

/// White on top, black below, right of the picture's lower half, where a fan leaves no room above for the text.
void drawGreyBar(const Measures& mm, double halfWidthMm, double rangeDb, FlatDrawing& drawing)
{
  constexpr int steps = 32;
  drawing.setPart(GREY_BAR);
  const double left = halfWidthMm + 0.02 * mm.depth;
  const double right = left + 0.035 * mm.depth;
  const double top = mm.bottom - 0.45 * mm.depth;
  const double stepMm = 0.4 * mm.depth / steps;
  for (int i = 0; i < steps; ++i)
  {
    const auto grey = static_cast<unsigned char>(std::lround(255.0 * (steps - 1 - i) / (steps - 1)));
    drawing.setColor({ grey, grey, grey });
    drawing.rectangle(left, top + stepMm * i, right, top + stepMm * (i + 1));
  }
  drawing.setColor(lightGrey);
  drawing.closedLine(
    { { left, top }, { right, top }, { right, top + steps * stepMm }, { left, top + steps * stepMm } });
  if (rangeDb > 0.0)
  {
    // Small, as what stands here makes the picture smaller.
    const double digitMm = 0.7 * mm.digit();
    const double textMm = right + 0.5 * mm.shortTick();
    drawing.text("0 dB", textMm, top, digitMm, Align::Left);
    drawing.text(std::to_string(-std::lround(rangeDb)), textMm, top + steps * stepMm, digitMm, Align::Left);
  }
}

/// `rangeDb`: from white to black; 0: not known.
void draw(const sono::ScanGeometry& geometry, double rangeDb, FlatDrawing& drawing)
{
  const auto outline = sono::scanOutline(geometry);
  const Measures mm(geometry);
  const double halfMm = halfWidthMm(outline[0]);
  drawDepth(mm, halfMm, drawing);
  drawLateral(mm, halfMm, drawing);
  drawGreyBar(mm, halfMm, rangeDb, drawing);
  drawing.setPart(MARKER);
  const double dotMm = 0.02 * mm.depth;
  const double clearMm = std::max(halfWidthMm(outline[1]), widthNearFaceMm(outline[0], 2.0 * dotMm));
  drawing.disc(clearMm + 2.0 * dotMm, 0.0, dotMm);
}

} // namespace

/// What was drawn last, and of what: pictures of a moving probe differ in other things, and what stays the same is not
/// uploaded anew by who shows it.
struct vtkSonoFlatScale::Drawn
{
  sono::ScanGeometry geometry;
  double rangeDb = 0.0;
  vtkNew<vtkPolyData> drawing;
};

vtkSonoFlatScale::vtkSonoFlatScale() = default;
vtkSonoFlatScale::~vtkSonoFlatScale() = default;

void vtkSonoFlatScale::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

int vtkSonoFlatScale::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
  return 1;
}

int vtkSonoFlatScale::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    vtkFieldData* fields = vtkDataSet::GetData(input[0])->GetFieldData();
    sono::ScanGeometry geometry = sono::readProbe(fields).geometry;
    geometry.elevationLineCount = 1; // of a volume the flat image shows the plane in the middle
    const double rangeDb = fields->HasArray("DynamicRangeDb") ? sono::readNumber("DynamicRangeDb", fields) : 0.0;
    if (!this->Last || this->Last->rangeDb != rangeDb || !sono::same(this->Last->geometry, geometry))
    {
      auto drawn = std::make_unique<Drawn>();
      drawn->geometry = geometry;
      drawn->rangeDb = rangeDb;
      FlatDrawing drawing;
      draw(geometry, rangeDb, drawing);
      drawing.finish(drawn->drawing);
      this->Last = std::move(drawn);
    }
    vtkPolyData::GetData(output)->ShallowCopy(this->Last->drawing); // without the input's fields, which VTK passes on
  });
}
