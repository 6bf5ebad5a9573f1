#include "SonoWay.h"

#include "SonoAnatomy.h"
#include "SonoProbeField.h"
#include "vtkSonoSceneBuilder.h"
#include "vtkSonoSceneHandle.h"

#include "vtkAlgorithm.h"
#include "vtkCellArray.h"
#include "vtkFieldData.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

#include <sstream>

namespace sono {

std::shared_ptr<const Scene> sceneToSearch(vtkDataObject* input, int fillBody, vtkAlgorithm* owner)
{
  if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(input))
  {
    return vtkSonoSceneHandle::Get(blocks);
  }
  vtkNew<vtkSonoSceneBuilder> builder;
  builder->SetFillBody(fillBody);
  builder->BuildSurfacesOff();
  builder->SetProgressText(owner->GetProgressText()); // it is a part of that
  Anatomy anatomy(owner, builder, 0.5, nullptr);      // the filter that makes a picture of it will say what there is
  return vtkSonoSceneHandle::Get(anatomy.blocks(input));
}

void drawWay(const Vec3d& begin, const Vec3d& end, vtkPolyData* way)
{
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  points->InsertNextPoint(&begin.x);
  points->InsertNextPoint(&end.x);
  lines->InsertNextCell({ 0, 1 });
  way->SetPoints(points);
  way->SetLines(lines);
}

void writeWay(const ProbePose& pose, double depthMm, vtkPolyData* way)
{
  drawWay(pose.positionMm, pose.positionMm + depthMm * pose.axial, way);
  vtkFieldData* field = way->GetFieldData();
  writeVector("ProbePositionMm", pose.positionMm, field);
  writeVector("ProbeAxial", pose.axial, field);
  writeVector("ProbeLateral", pose.lateral, field);
}

std::string rowOf(const ProbePose& pose, double depthMm, const std::string& preset, const std::string& sentence)
{
  std::ostringstream row;
  row.precision(17);
  row << sentence << '\t' << preset << '\t' << depthMm;
  for (const Vec3d& part : { pose.positionMm, pose.axial, pose.lateral })
  {
    row << '\t' << part.x << '\t' << part.y << '\t' << part.z;
  }
  return row.str();
}

vtkSmartPointer<vtkStringArray> namedStrings(const char* name, const std::vector<std::string>& values)
{
  auto array = vtkSmartPointer<vtkStringArray>::New();
  array->SetName(name);
  for (const std::string& value : values)
  {
    array->InsertNextValue(value);
  }
  return array;
}

} // namespace sono
