#include "vtkSonoCaliper.h"

#include "Image/Calipers.h"
#include "SonoFlatDrawing.h"
#include "SonoProbeField.h"
#include "SonoStage.h"

#include "vtkFieldData.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkSonoCaliper);

namespace {

using sono::Vec3d;
using Points = std::array<Vec3d, 3>;

double measure(int kind, const Points& p)
{
  return kind == vtkSonoCaliper::Distance  ? sono::distanceMm(p[0], p[1])
         : kind == vtkSonoCaliper::Ellipse ? sono::ellipseAreaMm2(p[0], p[1], p[2])
                                           : sono::angleDeg(p[0], p[1], p[2]);
}

/// As on a scanner: large areas in cm^2.
std::string written(int kind, double value)
{
  constexpr double mm2PerCm2 = 100.0;
  const bool isArea = kind == vtkSonoCaliper::Ellipse;
  const bool isLarge = isArea && value >= mm2PerCm2;
  char number[32];
  std::snprintf(number, sizeof number, isLarge ? "%.2f" : "%.1f", isLarge ? value / mm2PerCm2 : value);
  return std::string(number) + (isLarge ? " cm^2" : isArea ? " mm^2" : kind == vtkSonoCaliper::Angle ? " deg" : " mm");
}

void drawEllipse(const Points& p, sono::FlatDrawing& drawing)
{
  constexpr int corners = 72;
  const Vec3d centre = 0.5 * (p[0] + p[1]);
  const Vec3d along = 0.5 * (p[1] - p[0]);
  const Vec3d across = sono::ellipseHalfAxis(p[0], p[1], p[2]);
  std::vector<std::array<double, 2>> border;
  for (int i = 0; i < corners; ++i)
  {
    const double turn = 2.0 * vtkMath::Pi() * i / corners;
    const Vec3d at = centre + std::cos(turn) * along + std::sin(turn) * across;
    border.push_back({ at.x, at.y });
  }
  drawing.closedLine(border);
}

void draw(int kind, const Points& p, const std::string& text, double digitMm, sono::FlatDrawing& drawing)
{
  drawing.setColor({ 255, 230, 80 });
  const int used = kind == vtkSonoCaliper::Distance ? 2 : 3;
  const double armMm = 0.35 * digitMm;
  Vec3d right = p[0];
  for (int i = 0; i < used; ++i)
  {
    drawing.stroke(p[i].x - armMm, p[i].y, p[i].x + armMm, p[i].y);
    drawing.stroke(p[i].x, p[i].y - armMm, p[i].x, p[i].y + armMm);
    right = p[i].x > right.x ? p[i] : right;
  }
  drawing.stroke(p[0].x, p[0].y, p[1].x, p[1].y);
  if (kind == vtkSonoCaliper::Ellipse)
  {
    drawEllipse(p, drawing);
  }
  if (kind == vtkSonoCaliper::Angle)
  {
    drawing.stroke(p[0].x, p[0].y, p[2].x, p[2].y);
  }
  drawing.text(text, right.x + 2.0 * armMm, right.y, digitMm, sono::FlatDrawing::Align::Left);
}

} // namespace

vtkSonoCaliper::vtkSonoCaliper()
{
  this->SetNumberOfInputPorts(0);
}

vtkSonoCaliper::~vtkSonoCaliper() = default;

void vtkSonoCaliper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Kind: " << this->Kind << endl;
  for (const auto& [name, p] : { std::pair("Point1Mm", this->Point1Mm), std::pair("Point2Mm", this->Point2Mm),
                                 std::pair("Point3Mm", this->Point3Mm) })
  {
    os << indent << name << ": " << p[0] << " " << p[1] << " " << p[2] << endl;
  }
  os << indent << "DigitMm: " << this->DigitMm << endl;
}

int vtkSonoCaliper::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    const auto flat = [](const double* p) { return Vec3d(p[0], p[1], 0.0); };
    const Points points{ flat(this->Point1Mm), flat(this->Point2Mm), flat(this->Point3Mm) };
    const double value = measure(this->Kind, points);
    const std::string text = written(this->Kind, value);
    vtkPolyData* polyData = vtkPolyData::GetData(output);
    sono::FlatDrawing drawing;
    draw(this->Kind, points, text, this->DigitMm, drawing);
    drawing.finish(polyData);
    sono::writeNumber("Value", value, polyData->GetFieldData());
    vtkNew<vtkStringArray> words;
    words->SetName("Text");
    words->InsertNextValue(text);
    polyData->GetFieldData()->AddArray(words);
  });
}
