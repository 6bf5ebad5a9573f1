#include "SonoTargets.h"

#include "Core/Progress.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCleanPolyData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTriangleFilter.h"

#include <map>

namespace sono {
namespace {

/// One triangle a polygon at least, points at the same place merged, as many sources of VTK double them along edges.
void mergeAndTriangulate(vtkPolyData* polyData, vtkPolyData* result)
{
  vtkNew<vtkCleanPolyData> clean;
  clean->SetInputData(polyData);
  clean->SetTolerance(0.0);
  clean->ConvertPolysToLinesOff();
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputConnection(clean->GetOutputPort());
  triangles->PassLinesOff();
  triangles->PassVertsOff();
  triangles->Update();
  result->ShallowCopy(triangles->GetOutput());
}

vtkStringArray* tissueNames(vtkFieldData* field)
{
  auto* names = vtkStringArray::SafeDownCast(field->GetAbstractArray("Tissue"));
  return names && names->GetNumberOfValues() > 0 ? names : nullptr;
}

double rodDiameterMm(vtkFieldData* field)
{
  vtkDataArray* diameter = field->GetArray("RodDiameterMm");
  return diameter && diameter->GetNumberOfValues() > 0 ? diameter->GetTuple1(0) : 0.0;
}

const Tissue& findTissue(const std::string& name, const TissueTable& tissues)
{
  const Tissue* tissue = tissues.find(name);
  if (!tissue)
  {
    throw Error("The targets are of tissue '" + name +
                "', which is not in the tissue table; choose one of its tissues or add a row.");
  }
  return *tissue;
}

} // namespace

std::vector<TargetSurface> targetSurfaces(vtkPolyData* polyData, const std::string& tissueName,
                                          const TissueTable& tissues)
{
  if (!polyData || polyData->GetNumberOfCells() == 0)
  {
    return {};
  }
  vtkNew<vtkPolyData> surface;
  mergeAndTriangulate(polyData, surface);
  vtkStringArray* ofCells = tissueNames(surface->GetCellData());
  vtkStringArray* ofAll = tissueNames(polyData->GetFieldData());
  const double rodMm = rodDiameterMm(polyData->GetFieldData());
  const std::string common = ofAll ? std::string(ofAll->GetValue(0)) : tissueName;

  std::vector<Vec3d> points(static_cast<std::size_t>(surface->GetNumberOfPoints()));
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    surface->GetPoint(static_cast<vtkIdType>(i), &points[i].x);
  }
  std::map<std::string, TargetSurface> targets;
  if (!ofCells)
  {
    targets.try_emplace(common, TargetSurface{ common, findTissue(common, tissues), points, {}, rodMm });
  }
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < surface->GetNumberOfPolys(); ++cell)
  {
    const std::string name = ofCells ? std::string(ofCells->GetValue(cell)) : common;
    auto target = targets.find(name);
    if (target == targets.end())
    {
      target = targets.emplace(name, TargetSurface{ name, findTissue(name, tissues), points, {}, rodMm }).first;
    }
    surface->GetPolys()->GetCellAtId(cell, corners);
    target->second.triangles.push_back({ static_cast<int>(corners->GetId(0)), static_cast<int>(corners->GetId(1)),
                                         static_cast<int>(corners->GetId(2)) });
  }

  std::vector<TargetSurface> result;
  for (auto& [name, target] : targets)
  {
    result.push_back(std::move(target));
  }
  return result;
}

} // namespace sono
