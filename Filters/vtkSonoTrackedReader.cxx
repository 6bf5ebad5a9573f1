#include "vtkSonoTrackedReader.h"

#include "Core/Progress.h"
#include "Files/ReadTracked.h"
#include "SonoPoses.h"
#include "SonoStage.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cmath>

vtkStandardNewMacro(vtkSonoTrackedReader);

namespace {

sono::Mat4d matrixOf(const char* name, const double (&rows)[16])
{
  sono::Mat4d matrix;
  for (int n = 0; n < 16; ++n)
  {
    matrix[n % 4][n / 4] = rows[n];
  }
  const double volume = glm::determinant(sono::Mat3d(matrix));
  if (!std::all_of(rows, rows + 16, [](double number) { return std::isfinite(number); }) || !(volume > 0.0) ||
      rows[12] != 0.0 || rows[13] != 0.0 || rows[14] != 0.0 || rows[15] != 1.0)
  {
    throw sono::Error(std::string(name) + " must be a transform that does not mirror or flatten, row by row, the last "
                                          "row 0 0 0 1.");
  }
  return matrix;
}

void fill(const sono::TrackedPoses& tracked, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> times;
  times->SetName("TimeS");
  vtkNew<vtkIntArray> frames;
  frames->SetName("Frame");
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(static_cast<int>(tracked.poses.size()));
  for (std::size_t n = 0; n < tracked.poses.size(); ++n)
  {
    lines->InsertCellPoint(points->InsertNextPoint(&tracked.poses[n].positionMm.x));
    times->InsertNextValue(tracked.timesS[n]);
    frames->InsertNextValue(tracked.frames[n]);
  }
  output->SetPoints(points);
  output->SetLines(lines);
  output->GetPointData()->AddArray(sono::poseVectors("Axial", tracked.poses, &sono::ProbePose::axial));
  output->GetPointData()->AddArray(sono::poseVectors("Lateral", tracked.poses, &sono::ProbePose::lateral));
  output->GetPointData()->AddArray(times);
  output->GetPointData()->AddArray(frames);
}

} // namespace

vtkSonoTrackedReader::vtkSonoTrackedReader()
{
  this->SetNumberOfInputPorts(0);
  this->SetProgressText("Reading poses");
}

vtkSonoTrackedReader::~vtkSonoTrackedReader() = default;

void vtkSonoTrackedReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << endl;
  os << indent << "Transform: " << this->Transform << endl;
  for (const auto& [name, rows] :
       { std::pair("Calibration", this->Calibration), std::pair("Registration", this->Registration) })
  {
    os << indent << name << ":";
    for (int n = 0; n < 16; ++n)
    {
      os << " " << rows[n];
    }
    os << endl;
  }
}

int vtkSonoTrackedReader::CanReadFile(const char* fileName)
{
  const std::string name = fileName ? vtksys::SystemTools::LowerCase(fileName) : "";
  return vtksys::SystemTools::StringEndsWith(name, ".igs.mha") ||
         vtksys::SystemTools::StringEndsWith(name, ".igs.nrrd");
}

int vtkSonoTrackedReader::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    if (this->FileName.empty())
    {
      throw sono::Error("No tracked sequence is named; set FileName to one of PLUS, .igs.mha or .igs.nrrd.");
    }
    const sono::TrackedPoses tracked =
      sono::readTracked(this->FileName, this->Transform, matrixOf("Calibration", this->Calibration),
                        matrixOf("Registration", this->Registration));
    if (tracked.invalidCount > 0)
    {
      sono::warn(this, std::to_string(tracked.invalidCount) + " of " +
                         std::to_string(tracked.poses.size() + std::size_t(tracked.invalidCount)) + " frames of '" +
                         this->FileName + "' have no valid " + this->Transform + " and are left out.");
    }
    fill(tracked, vtkPolyData::GetData(output));
  });
}
