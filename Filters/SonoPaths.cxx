#include "SonoPaths.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkFloatArray.h"
#include "vtkIntArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <cmath>

namespace sono {
namespace {

/// Finite for what attenuation has brought to zero, too.
float decibels(float intensity)
{
  constexpr float faintest = 1e-20f;
  return 20.0f * std::log10(std::max(intensity, faintest));
}

template<class Array>
vtkSmartPointer<Array> pointArray(const char* name, vtkPolyData* polyData)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  polyData->GetPointData()->AddArray(array);
  return array;
}

} // namespace

std::vector<std::string> mediaNames(const Scene& scene, const std::vector<TargetSurface>& targets)
{
  std::vector<std::string> names;
  for (const Tissue& tissue : scene.tissues())
  {
    names.push_back(tissue.name);
  }
  for (const TargetSurface& target : targets)
  {
    names.push_back(target.tissue.name);
  }
  return names;
}

void fillPaths(const std::vector<RecordedPath>& paths, vtkPolyData* polyData)
{
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkFloatArray> intensity;
  vtkNew<vtkFloatArray> intensityDb;
  vtkNew<vtkIntArray> bounce;
  vtkNew<vtkIntArray> line;
  intensity->SetName("Intensity");
  intensityDb->SetName("IntensityDb");
  bounce->SetName("Bounce");
  line->SetName("Line");
  for (const RecordedPath& path : paths)
  {
    cells->InsertNextCell(static_cast<int>(path.pointMm.size()));
    line->InsertNextValue(path.line);
    for (std::size_t i = 0; i < path.pointMm.size(); ++i)
    {
      cells->InsertCellPoint(points->InsertNextPoint(&path.pointMm[i].x));
      intensity->InsertNextValue(path.intensity[i]);
      intensityDb->InsertNextValue(decibels(path.intensity[i]));
      bounce->InsertNextValue(path.bounce[i]);
    }
  }
  polyData->SetPoints(points);
  polyData->SetLines(cells);
  polyData->GetPointData()->SetScalars(intensityDb);
  polyData->GetPointData()->AddArray(intensity);
  polyData->GetPointData()->AddArray(bounce);
  polyData->GetCellData()->AddArray(line);
}

void fillHits(const std::vector<RecordedPath>& paths, const std::vector<std::string>& media, vtkPolyData* polyData)
{
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> vertices;
  const auto intensity = pointArray<vtkFloatArray>("Intensity", polyData);
  const auto intensityDb = pointArray<vtkFloatArray>("IntensityDb", polyData);
  const auto bounce = pointArray<vtkIntArray>("Bounce", polyData);
  const auto echo = pointArray<vtkFloatArray>("EchoAmplitude", polyData);
  const auto incidence = pointArray<vtkFloatArray>("IncidenceDeg", polyData);
  const auto depth = pointArray<vtkFloatArray>("DepthMm", polyData);
  const auto travelled = pointArray<vtkFloatArray>("PathMm", polyData);
  const auto line = pointArray<vtkIntArray>("Line", polyData);
  const auto from = pointArray<vtkStringArray>("FromTissue", polyData);
  const auto to = pointArray<vtkStringArray>("ToTissue", polyData);
  const auto normals = pointArray<vtkFloatArray>("Normals", polyData);
  normals->SetNumberOfComponents(3);
  for (const RecordedPath& path : paths)
  {
    for (const BoundaryHit& hit : path.hits)
    {
      vertices->InsertNextCell({ points->InsertNextPoint(&hit.pointMm.x) });
      intensity->InsertNextValue(hit.intensity);
      intensityDb->InsertNextValue(decibels(hit.intensity));
      bounce->InsertNextValue(hit.bounce);
      echo->InsertNextValue(hit.echo);
      incidence->InsertNextValue(vtkMath::DegreesFromRadians(std::acos(hit.incidenceCosine)));
      depth->InsertNextValue(hit.depthMm);
      travelled->InsertNextValue(hit.pathMm);
      line->InsertNextValue(path.line);
      from->InsertNextValue(media[static_cast<std::size_t>(hit.from)]);
      to->InsertNextValue(media[static_cast<std::size_t>(hit.to)]);
      normals->InsertNextTuple3(hit.normal.x, hit.normal.y, hit.normal.z);
    }
  }
  polyData->SetPoints(points);
  polyData->SetVerts(vertices);
  polyData->GetPointData()->SetScalars(intensityDb);
  polyData->GetPointData()->SetNormals(normals);
}

} // namespace sono
