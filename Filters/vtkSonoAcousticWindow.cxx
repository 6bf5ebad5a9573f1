#include "vtkSonoAcousticWindow.h"

#include "Probe/AcousticWindow.h"
#include "SonoAnatomy.h"
#include "SonoProbeField.h"
#include "SonoStage.h"
#include "vtkSonoSceneBuilder.h"
#include "vtkSonoSceneHandle.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <optional>

vtkStandardNewMacro(vtkSonoAcousticWindow);

namespace {

/// The scene of the input, or of the label image that it is.
std::shared_ptr<const sono::Scene> sceneOf(vtkDataObject* input, bool fillBody, vtkAlgorithm* owner)
{
  if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(input))
  {
    return vtkSonoSceneHandle::Get(blocks);
  }
  vtkNew<vtkSonoSceneBuilder> builder;
  builder->SetFillBody(fillBody);
  builder->BuildSurfacesOff();
  builder->SetProgressText(owner->GetProgressText()); // it is a part of that
  return vtkSonoSceneHandle::Get(sono::Anatomy(owner, builder, 0.5).blocks(input));
}

/// The pose that the data bring along.
std::optional<sono::ProbePose> carriedPose(vtkFieldData* field)
{
  sono::ProbePose pose;
  const std::pair<const char*, sono::Vec3d*> parts[] = { { "A4CPositionMm", &pose.positionMm },
                                                         { "A4CAxial", &pose.axial },
                                                         { "A4CLateral", &pose.lateral } };
  for (const auto& [name, value] : parts)
  {
    vtkDataArray* array = field->GetArray(name);
    if (!array || array->GetNumberOfTuples() != 1 || array->GetNumberOfComponents() != 3)
    {
      return std::nullopt;
    }
    array->GetTuple(0, &value->x);
  }
  return pose.orthonormalized();
}

} // namespace

vtkSonoAcousticWindow::vtkSonoAcousticWindow()
{
  this->SetProgressText("Looking for an acoustic window");
}

vtkSonoAcousticWindow::~vtkSonoAcousticWindow() = default;

void vtkSonoAcousticWindow::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FillBody: " << this->FillBody << endl;
  os << indent << "ChooseTarget: " << this->ChooseTarget << endl;
  os << indent << "TargetMm: " << this->TargetMm[0] << " " << this->TargetMm[1] << " " << this->TargetMm[2] << endl;
  os << indent << "CentreFrequencyMHz: " << this->CentreFrequencyMHz << endl;
}

int vtkSonoAcousticWindow::FillInputPortInformation(int, vtkInformation* info)
{
  // The composite one first: the pipeline would otherwise hand a scene over block by block.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkMultiBlockDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1); // so that one clear sentence says what is missing
  return 1;
}

int vtkSonoAcousticWindow::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  return vtkImageData::GetData(input[0]) ? sono::requestWholeImage(input) : 1;
}

int vtkSonoAcousticWindow::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    if (!(this->CentreFrequencyMHz > 0.0))
    {
      throw sono::Error("CentreFrequencyMHz must be above 0.");
    }
    vtkDataObject* data = vtkDataObject::GetData(input[0]);
    if (!data)
    {
      throw sono::Error("No label map is connected; select one before you make the filter, or set its Input.");
    }
    const auto scene = sceneOf(data, this->FillBody, this);
    const auto carried = this->ChooseTarget ? std::nullopt : carriedPose(data->GetFieldData());
    const sono::Vec3d target = this->ChooseTarget ? sono::Vec3d(this->TargetMm[0], this->TargetMm[1], this->TargetMm[2])
                                                  : sono::defaultTarget(*scene);
    const sono::ProbePose pose =
      carried ? *carried : sono::findAcousticWindow(*scene, target, this->CentreFrequencyMHz);

    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> lines;
    const sono::Vec3d end = pose.positionMm + glm::dot(target - pose.positionMm, pose.axial) * pose.axial;
    points->InsertNextPoint(&pose.positionMm.x);
    points->InsertNextPoint(&end.x);
    lines->InsertNextCell({ 0, 1 });
    vtkPolyData* way = vtkPolyData::GetData(output);
    way->SetPoints(points);
    way->SetLines(lines);
    sono::writeVector("ProbePositionMm", pose.positionMm, way->GetFieldData());
    sono::writeVector("ProbeAxial", pose.axial, way->GetFieldData());
    sono::writeVector("ProbeLateral", pose.lateral, way->GetFieldData());
  });
}
