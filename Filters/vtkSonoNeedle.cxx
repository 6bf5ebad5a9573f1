#include "vtkSonoNeedle.h"

#include "Core/Require.h"
#include "Kernel/Vec.h"
#include "SonoStage.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

#include <cmath>

vtkStandardNewMacro(vtkSonoNeedle);

namespace {

using sono::Vec3d;

constexpr int sides = 24;

/// Of a cross-section with the circle's area.
double cornerRadiusMm(double diameterMm)
{
  const double turn = 2.0 * vtkMath::Pi() / sides;
  return 0.5 * diameterMm * std::sqrt(turn / std::sin(turn));
}

/// Across the shaft, to the side where the point is.
Vec3d pointSide(const Vec3d& along, double rollDeg)
{
  const Vec3d upright = std::abs(along.z) < 0.999 ? Vec3d(0.0, 0.0, 1.0) : Vec3d(1.0, 0.0, 0.0);
  const Vec3d side = glm::normalize(upright - glm::dot(upright, along) * along);
  const double roll = vtkMath::RadiansFromDegrees(rollDeg);
  return std::cos(roll) * side + std::sin(roll) * glm::cross(along, side);
}

} // namespace

vtkSonoNeedle::vtkSonoNeedle()
{
  this->SetNumberOfInputPorts(0);
}

vtkSonoNeedle::~vtkSonoNeedle() = default;

void vtkSonoNeedle::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "HubMm: " << this->HubMm[0] << " " << this->HubMm[1] << " " << this->HubMm[2] << endl;
  os << indent << "TipMm: " << this->TipMm[0] << " " << this->TipMm[1] << " " << this->TipMm[2] << endl;
  os << indent << "DiameterMm: " << this->DiameterMm << endl;
  os << indent << "BevelDeg: " << this->BevelDeg << endl;
  os << indent << "RollDeg: " << this->RollDeg << endl;
  os << indent << "Tissue: " << this->Tissue << endl;
}

int vtkSonoNeedle::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    sono::requireInRange(this->DiameterMm >= 0.1 && this->DiameterMm <= 10.0, "diameter of the needle (mm)",
                         this->DiameterMm, "0.1 to 10");
    sono::requireInRange(this->BevelDeg >= 5.0 && this->BevelDeg <= 90.0, "bevel of the needle (degrees)",
                         this->BevelDeg, "5 to 90");
    const Vec3d hub(this->HubMm[0], this->HubMm[1], this->HubMm[2]);
    const Vec3d tip(this->TipMm[0], this->TipMm[1], this->TipMm[2]);
    const double lengthMm = glm::distance(hub, tip);
    const double radiusMm = cornerRadiusMm(this->DiameterMm);
    const double perRadius = 1.0 / std::tan(vtkMath::RadiansFromDegrees(this->BevelDeg));
    if (!(lengthMm > 2.0 * radiusMm * perRadius + 0.1))
    {
      throw sono::Error("The needle is " + std::to_string(lengthMm) +
                        " mm long, no longer than its bevel; set hub and tip farther apart, or a steeper bevel.");
    }
    const Vec3d along = (tip - hub) / lengthMm;
    const Vec3d side = pointSide(along, this->RollDeg);
    const Vec3d across = glm::cross(along, side);
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (const bool isTip : { false, true })
    {
      for (int i = 0; i < sides; ++i)
      {
        const double turn = 2.0 * vtkMath::Pi() * i / sides;
        // The first one is the point, and the others fall behind it by the bevel's slope.
        const double behindMm = radiusMm * (1.0 - std::cos(turn)) * perRadius;
        const Vec3d middle = isTip ? tip - behindMm * along : hub;
        const Vec3d p = middle + radiusMm * (std::cos(turn) * side + std::sin(turn) * across);
        points->InsertNextPoint(p.x, p.y, p.z);
      }
    }
    vtkNew<vtkCellArray> polygons; // their normals look out
    for (vtkIdType i = 0; i < sides; ++i)
    {
      const vtkIdType next = (i + 1) % sides;
      polygons->InsertNextCell({ i, next, sides + next });
      polygons->InsertNextCell({ i, sides + next, sides + i });
      if (i > 0 && next > 0)
      {
        polygons->InsertNextCell({ vtkIdType(0), next, i });
        polygons->InsertNextCell({ vtkIdType(sides), sides + i, sides + next });
      }
    }
    vtkNew<vtkStringArray> tissue;
    tissue->SetName("Tissue");
    tissue->InsertNextValue(this->Tissue);
    vtkNew<vtkDoubleArray> diameter;
    diameter->SetName("RodDiameterMm");
    diameter->InsertNextValue(this->DiameterMm);
    vtkPolyData* needle = vtkPolyData::GetData(output);
    needle->SetPoints(points);
    needle->SetPolys(polygons);
    needle->GetFieldData()->AddArray(tissue);
    needle->GetFieldData()->AddArray(diameter);
  });
}
