#include "vtkSonoProbePath.h"

#include "Core/Error.h"
#include "SonoPoses.h"
#include "SonoStage.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <string>

vtkStandardNewMacro(vtkSonoProbePath);

namespace {

constexpr int perPose = 10;

sono::ProbePose poseOf(const double* n, int index)
{
  try
  {
    return sono::ProbePose{ { n[1], n[2], n[3] }, { n[4], n[5], n[6] }, { n[7], n[8], n[9] } }.orthonormalized();
  }
  catch (const sono::Error& error)
  {
    throw sono::Error("Pose " + std::to_string(index) + ": " + error.what());
  }
}

} // namespace

vtkSonoProbePath::vtkSonoProbePath()
{
  this->SetNumberOfInputPorts(0);
}

vtkSonoProbePath::~vtkSonoProbePath() = default;

void vtkSonoProbePath::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfPoses: " << this->Count() << endl;
}

void vtkSonoProbePath::SetNumberOfPoses(int count)
{
  if (count >= 0 && count != this->Count())
  {
    this->Numbers.resize(std::size_t(count) * perPose);
    this->Modified();
  }
}

void vtkSonoProbePath::SetPose(int index, double timeS, double x, double y, double z, double axialX, double axialY,
                               double axialZ, double lateralX, double lateralY, double lateralZ)
{
  if (index < 0)
  {
    return;
  }
  this->SetNumberOfPoses(std::max(index + 1, this->Count()));
  const double pose[perPose] = { timeS, x, y, z, axialX, axialY, axialZ, lateralX, lateralY, lateralZ };
  std::copy(pose, pose + perPose, this->Numbers.begin() + std::ptrdiff_t(index) * perPose);
  this->Modified();
}

int vtkSonoProbePath::Count() const
{
  return int(this->Numbers.size()) / perPose;
}

int vtkSonoProbePath::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    const int count = this->Count();
    if (count == 0)
    {
      throw sono::Error("The path has no poses; record one with Record of the panel Ultrasound Scanner.");
    }
    std::vector<sono::ProbePose> poses;
    vtkNew<vtkDoubleArray> times;
    times->SetName("TimeS");
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    vtkNew<vtkCellArray> lines;
    lines->InsertNextCell(count);
    for (int i = 0; i < count; ++i)
    {
      const double* numbers = this->Numbers.data() + std::ptrdiff_t(i) * perPose;
      if (i > 0 && !(numbers[0] >= numbers[-perPose]))
      {
        throw sono::Error("Pose " + std::to_string(i) + " is earlier than the one before it, at " +
                          std::to_string(numbers[0]) + " s; times must not go back.");
      }
      poses.push_back(poseOf(numbers, i));
      times->InsertNextValue(numbers[0]);
      points->InsertNextPoint(&poses.back().positionMm.x);
      lines->InsertCellPoint(i);
    }
    vtkPolyData* path = vtkPolyData::GetData(output);
    path->SetPoints(points);
    path->SetLines(lines);
    path->GetPointData()->AddArray(sono::poseVectors("Axial", poses, &sono::ProbePose::axial));
    path->GetPointData()->AddArray(sono::poseVectors("Lateral", poses, &sono::ProbePose::lateral));
    path->GetPointData()->AddArray(times);
  });
}
