#include "vtkSonoFlatScale.h"

#include "SonoImagePlacement.h"
#include "SonoProbeField.h"
#include "SonoStage.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkVectorText.h"

#include <algorithm>
#include <cmath>
#include <string>

vtkStandardNewMacro(vtkSonoFlatScale);

namespace {

enum Part
{
  RULER = 0,
  MARKER = 1
};

/// Strokes, discs and letters in the plane of the image, in mm, y down.
class Drawing
{
public:
  void stroke(double x0, double y0, double x1, double y1)
  {
    lines_->InsertNextCell({ point(x0, y0), point(x1, y1) });
    lineParts_->InsertNextValue(RULER);
  }

  void disc(double x, double y, double radius)
  {
    constexpr int corners = 32;
    polygons_->InsertNextCell(corners);
    for (int i = 0; i < corners; ++i)
    {
      const double angle = 2.0 * vtkMath::Pi() * i / corners;
      polygons_->InsertCellPoint(point(x + radius * std::cos(angle), y + radius * std::sin(angle)));
    }
    polygonParts_->InsertNextValue(MARKER);
  }

  /// Its middle at `y`, and its right end at `x`.
  void text(const std::string& content, double x, double y, double height)
  {
    vtkNew<vtkVectorText> letters;
    letters->SetText(content.c_str());
    letters->Update();
    vtkPolyData* shape = letters->GetOutput();
    const double* box = shape->GetBounds();
    const double scale = height / (box[3] - box[2]);
    const double left = x - scale * (box[1] - box[0]);
    vtkNew<vtkIdList> corners;
    for (vtkIdType cell = 0; cell < shape->GetNumberOfCells(); ++cell)
    {
      shape->GetCellPoints(cell, corners);
      polygons_->InsertNextCell(static_cast<int>(corners->GetNumberOfIds()));
      for (const vtkIdType id : *corners)
      {
        const double* at = shape->GetPoint(id);
        polygons_->InsertCellPoint(
          point(left + scale * (at[0] - box[0]), y - scale * (at[1] - (box[2] + box[3]) / 2.0)));
      }
      polygonParts_->InsertNextValue(RULER);
    }
  }

  void finish(vtkPolyData* polyData)
  {
    vtkNew<vtkIntArray> parts;
    parts->SetName("Part");
    for (vtkIntArray* some : { lineParts_.Get(), polygonParts_.Get() }) // lines come first in poly data
    {
      parts->InsertTuples(parts->GetNumberOfTuples(), some->GetNumberOfTuples(), 0, some);
    }
    polyData->SetPoints(points_);
    polyData->SetLines(lines_);
    polyData->SetPolys(polygons_);
    polyData->GetCellData()->AddArray(parts);
  }

private:
  vtkIdType point(double x, double y) { return points_->InsertNextPoint(x, y, sono::flatDrawingMm); }

  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> lines_;
  vtkNew<vtkCellArray> polygons_;
  vtkNew<vtkIntArray> lineParts_;
  vtkNew<vtkIntArray> polygonParts_;
};

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

void draw(const sono::ScanGeometry& geometry, Drawing& drawing)
{
  const auto outline = sono::scanOutline(geometry);
  const double depthMm = geometry.depthMm;
  const double faceMm = geometry.lineOrigin() == sono::LineOrigin::Catheter ? geometry.radiusMm : 0.0;
  const int numberedCm = depthMm < 80.0 ? 1 : 5;
  const double rulerMm = -halfWidthMm(outline[0]) - 0.03 * depthMm;
  drawing.stroke(rulerMm, faceMm, rulerMm, faceMm + depthMm);
  for (int cm = 0; cm <= std::floor(depthMm / 10.0 + 1e-9); ++cm)
  {
    const bool isNumbered = cm % numberedCm == 0;
    const double yMm = faceMm + 10.0 * cm;
    const double tickMm = rulerMm - (isNumbered ? 0.03 : 0.015) * depthMm;
    drawing.stroke(rulerMm, yMm, tickMm, yMm);
    if (isNumbered)
    {
      drawing.text(std::to_string(cm) + (cm == 0 ? " cm" : ""), tickMm - 0.015 * depthMm, yMm, 0.05 * depthMm);
    }
  }
  const double dotMm = 0.02 * depthMm;
  const double clearMm = std::max(halfWidthMm(outline[1]), widthNearFaceMm(outline[0], 2.0 * dotMm));
  drawing.disc(clearMm + 2.0 * dotMm, 0.0, dotMm);
}

} // namespace

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
    const sono::ScanGeometry geometry = sono::readProbe(vtkDataSet::GetData(input[0])->GetFieldData()).geometry;
    if (!geometry.isVolume())
    {
      Drawing drawing;
      draw(geometry, drawing);
      drawing.finish(vtkPolyData::GetData(output));
    }
  });
}
