#include "SonoFlatDrawing.h"

#include "SonoImagePlacement.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkIdList.h"
#include "vtkIntArray.h"
#include "vtkMath.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVectorText.h"

#include <cmath>

namespace sono {
namespace {

vtkSmartPointer<vtkPolyData> lettersOf(const std::string& content)
{
  vtkNew<vtkVectorText> letters;
  letters->SetText(content.c_str());
  letters->Update();
  return letters->GetOutput();
}

} // namespace

FlatDrawing::Cells::Cells()
{
  colors->SetNumberOfComponents(3);
}

FlatDrawing::Cells::~Cells() = default;
FlatDrawing::FlatDrawing() = default;
FlatDrawing::~FlatDrawing() = default;

long long FlatDrawing::point(double x, double y)
{
  return points_->InsertNextPoint(x, y, flatDrawingMm);
}

void FlatDrawing::take(Cells& cells) const
{
  cells.parts->InsertNextValue(part_);
  for (const unsigned char channel : color_)
  {
    cells.colors->InsertNextValue(channel);
  }
}

void FlatDrawing::stroke(double x0, double y0, double x1, double y1)
{
  lines_.cells->InsertNextCell({ point(x0, y0), point(x1, y1) });
  take(lines_);
}

void FlatDrawing::closedLine(const std::vector<std::array<double, 2>>& corners)
{
  lines_.cells->InsertNextCell(static_cast<int>(corners.size() + 1));
  const vtkIdType first = points_->GetNumberOfPoints();
  for (const auto& corner : corners)
  {
    lines_.cells->InsertCellPoint(point(corner[0], corner[1]));
  }
  lines_.cells->InsertCellPoint(first);
  take(lines_);
}

void FlatDrawing::disc(double x, double y, double radius)
{
  constexpr int corners = 32;
  polygons_.cells->InsertNextCell(corners);
  for (int i = 0; i < corners; ++i)
  {
    const double angle = 2.0 * vtkMath::Pi() * i / corners;
    polygons_.cells->InsertCellPoint(point(x + radius * std::cos(angle), y + radius * std::sin(angle)));
  }
  take(polygons_);
}

void FlatDrawing::rectangle(double x0, double y0, double x1, double y1)
{
  polygons_.cells->InsertNextCell({ point(x0, y0), point(x1, y0), point(x1, y1), point(x0, y1) });
  take(polygons_);
}

void FlatDrawing::text(const std::string& content, double x, double y, double height, Align align)
{
  double digit[6];
  lettersOf("0")->GetBounds(digit);
  const vtkSmartPointer<vtkPolyData> shape = lettersOf(content);
  double box[6];
  shape->GetBounds(box);
  const double scale = height / (digit[3] - digit[2]);
  const double share = align == Align::Left ? 0.0 : align == Align::Centre ? 0.5 : 1.0;
  const double left = x - share * scale * (box[1] - box[0]);
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < shape->GetNumberOfCells(); ++cell)
  {
    shape->GetCellPoints(cell, corners);
    polygons_.cells->InsertNextCell(static_cast<int>(corners->GetNumberOfIds()));
    for (const vtkIdType id : *corners)
    {
      const double* at = shape->GetPoint(id);
      polygons_.cells->InsertCellPoint(
        point(left + scale * (at[0] - box[0]), y - scale * (at[1] - (digit[2] + digit[3]) / 2.0)));
    }
    take(polygons_);
  }
}

void FlatDrawing::finish(vtkPolyData* polyData)
{
  vtkNew<vtkIntArray> parts;
  parts->SetName("Part");
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetName("Color");
  colors->SetNumberOfComponents(3);
  for (Cells* some : { &lines_, &polygons_ }) // lines come first in poly data
  {
    parts->InsertTuples(parts->GetNumberOfTuples(), some->parts->GetNumberOfTuples(), 0, some->parts);
    colors->InsertTuples(colors->GetNumberOfTuples(), some->colors->GetNumberOfTuples(), 0, some->colors);
  }
  polyData->SetPoints(points_);
  polyData->SetLines(lines_.cells);
  polyData->SetPolys(polygons_.cells);
  polyData->GetCellData()->AddArray(parts);
  polyData->GetCellData()->AddArray(colors);
}

} // namespace sono
