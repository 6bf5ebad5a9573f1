#include "SonoPaths.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkFloatArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>

namespace sono {

void fillPaths(const std::vector<RecordedPath>& paths, vtkPolyData* polyData)
{
  constexpr float faintest = 1e-20f; // keeps the logarithm finite for what attenuation has brought to zero
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
      intensityDb->InsertNextValue(20.0f * std::log10(std::max(path.intensity[i], faintest)));
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

} // namespace sono
