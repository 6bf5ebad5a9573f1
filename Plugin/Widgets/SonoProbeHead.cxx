#include "SonoProbeHead.h"

#include "vtkCell.h"
#include "vtkCellArray.h"
#include "vtkCylinderSource.h"
#include "vtkFieldData.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace {

constexpr int ringPoints = 32;

/// One cross-section of a hand-held probe: half its width and thickness at a distance behind the face.
struct Section
{
  double behindMm;
  double halfWidthMm;
  double halfThicknessMm;
};

/// How far the face of the array lies behind its middle at a lateral position: a convex one falls back to its ends.
double faceAt(vtkPoints* face, double lateralMm)
{
  const vtkIdType last = face->GetNumberOfPoints() - 1;
  for (vtkIdType i = 0; i < last; ++i)
  {
    double a[3];
    double b[3];
    face->GetPoint(i, a);
    face->GetPoint(i + 1, b);
    const double lower = std::min(a[0], b[0]);
    const double upper = std::max(a[0], b[0]);
    if (lateralMm >= lower && lateralMm <= upper && upper > lower)
    {
      return a[2] + (b[2] - a[2]) * (lateralMm - a[0]) / (b[0] - a[0]);
    }
  }
  double first[3];
  double end[3];
  face->GetPoint(0, first);
  face->GetPoint(last, end);
  return std::min(first[2], end[2]);
}

double numberOf(const char* name, vtkPolyData* outline)
{
  return outline->GetFieldData()->GetArray(name)->GetTuple1(0);
}

} // namespace

SonoProbeHead::SonoProbeHead(vtkPolyData* outline)
{
  if (numberOf("IsCatheter", outline) != 0.0)
  {
    this->radialMm = numberOf("RadiusMm", outline);
    this->halfWidthMm = this->radialMm;
    this->makeCatheter();
  }
  else
  {
    this->makeHandHeld(outline);
  }
}

void SonoProbeHead::makeHandHeld(vtkPolyData* outline)
{
  vtkPoints* face = outline->GetCell(1)->GetPoints();
  const bool isVolume = numberOf("IsVolume", outline) != 0.0;
  if (!isVolume) // whose cell 1 is an edge of the volume; its lines start in one point
  {
    for (vtkIdType i = 0; i < face->GetNumberOfPoints(); ++i)
    {
      this->halfWidthMm = std::max(this->halfWidthMm, std::abs(face->GetPoint(i)[0]) + 2.0);
    }
  }
  const double half = this->halfWidthMm;
  const double grip = std::min(half, 13.0);
  const std::array<Section, 6> sections{ { { 0.0, half - 1.5, 0.5 * thicknessMm - 1.5 },
                                           { 2.0, half, 0.5 * thicknessMm },
                                           { 18.0, half, 0.5 * thicknessMm },
                                           { 30.0, grip, 0.5 * thicknessMm },
                                           { 56.0, 0.8 * grip, 0.45 * thicknessMm },
                                           { tailMm, 3.0, 3.0 } } };
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> polygons;
  for (std::size_t s = 0; s < sections.size(); ++s)
  {
    const Section& section = sections[s];
    for (int i = 0; i < ringPoints; ++i)
    {
      const double angle = 2.0 * vtkMath::Pi() * i / ringPoints;
      // A rounded rectangle.
      const auto squared = [](double v) { return std::copysign(std::sqrt(std::abs(v)), v); };
      const double x = section.halfWidthMm * squared(std::cos(angle));
      const double y = section.halfThicknessMm * squared(std::sin(angle));
      const double curve = isVolume || section.behindMm > 2.0 ? 0.0 : faceAt(face, x);
      points->InsertNextPoint(x, y, curve - section.behindMm);
    }
  }
  const auto at = [](std::size_t section, int i) {
    return static_cast<vtkIdType>(section * ringPoints + i % ringPoints);
  };
  for (std::size_t s = 0; s + 1 < sections.size(); ++s)
  {
    for (int i = 0; i < ringPoints; ++i)
    {
      polygons->InsertNextCell({ at(s, i), at(s + 1, i), at(s + 1, i + 1), at(s, i + 1) });
    }
  }
  for (const std::size_t end : { std::size_t(0), sections.size() - 1 })
  {
    polygons->InsertNextCell(ringPoints);
    for (int i = 0; i < ringPoints; ++i)
    {
      polygons->InsertCellPoint(at(end, end == 0 ? i : ringPoints - 1 - i));
    }
  }
  this->surface = vtkSmartPointer<vtkPolyData>::New();
  this->surface->SetPoints(points);
  this->surface->SetPolys(polygons);
}

void SonoProbeHead::makeCatheter()
{
  vtkNew<vtkCylinderSource> cylinder; // along y, the elevation
  cylinder->SetRadius(this->radialMm);
  cylinder->SetHeight(tailMm);
  cylinder->SetResolution(ringPoints);
  cylinder->Update();
  this->surface = cylinder->GetOutput();
}
