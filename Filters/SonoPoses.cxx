#include "SonoPoses.h"

#include "Core/Error.h"

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkTable.h"

#include <string>

namespace sono {
namespace {

struct PoseColumns
{
  const char* name;
  Vec3d ProbePose::*vector;
};
constexpr PoseColumns poseColumns[] = { { "Position", &ProbePose::positionMm },
                                        { "Axial", &ProbePose::axial },
                                        { "Lateral", &ProbePose::lateral } };
constexpr PoseColumns fieldArrays[] = { { "PosePositionMm", &ProbePose::positionMm },
                                        { "PoseAxial", &ProbePose::axial },
                                        { "PoseLateral", &ProbePose::lateral } };
constexpr const char* axes[] = { "X", "Y", "Z" };

vtkDataArray* vectorsOf(vtkPointSet* points, const char* name)
{
  vtkDataArray* array = points->GetPointData()->GetArray(name);
  if (!array || array->GetNumberOfComponents() != 3)
  {
    throw Error(std::string("The poses have no point array '") + name +
                "' with three components; add it, for example with a Calculator.");
  }
  return array;
}

std::vector<ProbePose> posesOfPoints(vtkPointSet* points)
{
  vtkDataArray* axial = vectorsOf(points, "Axial");
  vtkDataArray* lateral = vectorsOf(points, "Lateral");
  std::vector<ProbePose> poses(static_cast<std::size_t>(points->GetNumberOfPoints()));
  for (std::size_t i = 0; i < poses.size(); ++i)
  {
    const auto id = static_cast<vtkIdType>(i);
    points->GetPoint(id, &poses[i].positionMm.x);
    axial->GetTuple(id, &poses[i].axial.x);
    lateral->GetTuple(id, &poses[i].lateral.x);
  }
  return poses;
}

std::vector<ProbePose> posesOfTable(vtkTable* table)
{
  std::vector<ProbePose> poses(static_cast<std::size_t>(table->GetNumberOfRows()));
  for (const auto& [name, vector] : poseColumns)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::string column = std::string(name) + axes[axis];
      auto* values = vtkDataArray::SafeDownCast(table->GetColumnByName(column.c_str()));
      if (!values || values->GetNumberOfComponents() != 1)
      {
        throw Error("The table of poses has no column of numbers '" + column +
                    "'; it needs PositionX, PositionY, PositionZ, AxialX to AxialZ and LateralX to LateralZ.");
      }
      for (std::size_t i = 0; i < poses.size(); ++i)
      {
        (poses[i].*vector)[axis] = values->GetTuple1(static_cast<vtkIdType>(i));
      }
    }
  }
  return poses;
}

} // namespace

std::vector<ProbePose> posesOf(vtkDataObject* data)
{
  auto* table = vtkTable::SafeDownCast(data);
  auto* points = vtkPointSet::SafeDownCast(data);
  if (!table && !points)
  {
    throw Error("No poses are connected; give points with the arrays Axial and Lateral, or a table.");
  }
  std::vector<ProbePose> poses = table ? posesOfTable(table) : posesOfPoints(points);
  if (poses.empty())
  {
    throw Error("There are no poses; give at least one point, or one row of a table.");
  }
  for (std::size_t i = 0; i < poses.size(); ++i)
  {
    try
    {
      poses[i] = poses[i].orthonormalized();
    }
    catch (const Error& error)
    {
      throw Error("Pose " + std::to_string(i) + ": " + error.what());
    }
  }
  return poses;
}

void fillPoses(const std::vector<ProbePose>& poses, vtkTable* table)
{
  for (const auto& [name, vector] : poseColumns)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      vtkNew<vtkDoubleArray> column;
      column->SetName((std::string(name) + axes[axis]).c_str());
      for (const ProbePose& pose : poses)
      {
        column->InsertNextValue((pose.*vector)[axis]);
      }
      table->AddColumn(column);
    }
  }
}

vtkSmartPointer<vtkDoubleArray> poseVectors(const char* name, const std::vector<ProbePose>& poses,
                                            Vec3d ProbePose::*vector)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(3);
  for (const ProbePose& pose : poses)
  {
    array->InsertNextTuple(&(pose.*vector).x);
  }
  return array;
}

void writePoses(const std::vector<ProbePose>& poses, vtkFieldData* field)
{
  for (const auto& [name, vector] : fieldArrays)
  {
    field->AddArray(poseVectors(name, poses, vector));
  }
}

std::vector<ProbePose> readPoses(vtkFieldData* field)
{
  std::vector<ProbePose> poses;
  for (const auto& [name, vector] : fieldArrays)
  {
    vtkDataArray* array = field->GetArray(name);
    if (!array || array->GetNumberOfComponents() != 3)
    {
      return {};
    }
    poses.resize(std::size_t(array->GetNumberOfTuples()));
    for (std::size_t n = 0; n < poses.size(); ++n)
    {
      array->GetTuple(vtkIdType(n), &(poses[n].*vector).x);
    }
  }
  return poses;
}

std::vector<ProbePose> picturePoses(vtkFieldData* field, const ProbePose& probe, std::size_t count)
{
  const std::vector<ProbePose> poses = readPoses(field);
  return poses.empty() ? std::vector<ProbePose>(count, probe) : poses;
}

} // namespace sono
