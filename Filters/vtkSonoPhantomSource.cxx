#include "vtkSonoPhantomSource.h"

#include "Core/Require.h"
#include "Phantoms/CalibrationPhantom.h"
#include "Phantoms/TestObjects.h"
#include "SonoDataFile.h"
#include "SonoLabelImage.h"
#include "SonoProbeField.h"
#include "SonoStage.h"

#include "vtkCellArray.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

vtkStandardNewMacro(vtkSonoPhantomSource);

namespace {

void writeView(int view, const sono::ProbePose& pose, vtkFieldData* field)
{
  const std::string name = "View" + std::to_string(view);
  sono::writeVector((name + "PositionMm").c_str(), pose.positionMm, field);
  sono::writeVector((name + "Axial").c_str(), pose.axial, field);
  sono::writeVector((name + "Lateral").c_str(), pose.lateral, field);
}

void writeSurface(const sono::TargetSurface& surface, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const sono::Vec3d& p : surface.pointsMm)
  {
    points->InsertNextPoint(p.x, p.y, p.z);
  }
  vtkNew<vtkCellArray> polygons;
  for (const auto& t : surface.triangles)
  {
    polygons->InsertNextCell({ t[0], t[1], t[2] });
  }
  vtkNew<vtkStringArray> tissue;
  tissue->SetName("Tissue");
  tissue->InsertNextValue(surface.tissue.name);
  output->SetPoints(points);
  output->SetPolys(polygons);
  output->GetFieldData()->AddArray(tissue);
}

void writeScatterers(const std::vector<sono::PointScatterer>& scatterers, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkFloatArray> amplitude;
  amplitude->SetName("Amplitude");
  vtkNew<vtkCellArray> vertices;
  for (const sono::PointScatterer& s : scatterers)
  {
    const vtkIdType id = points->InsertNextPoint(s.positionMm.x, s.positionMm.y, s.positionMm.z);
    vertices->InsertNextCell(1, &id);
    amplitude->InsertNextValue(s.amplitude);
  }
  output->SetPoints(points);
  output->SetVerts(vertices);
  output->GetPointData()->AddArray(amplitude);
}

} // namespace

vtkSonoPhantomSource::vtkSonoPhantomSource()
{
  this->SetNumberOfInputPorts(0);
  this->SetNumberOfOutputPorts(3);
  this->SetProgressText("Making the phantom");
}

vtkSonoPhantomSource::~vtkSonoPhantomSource() = default;

void vtkSonoPhantomSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Phantom: " << this->Phantom << endl;
  os << indent << "SpacingMm: " << this->SpacingMm << endl;
  os << indent << "TargetFile: " << this->TargetFile << endl;
  os << indent << "ThicknessMm: " << this->ThicknessMm << endl;
  os << indent << "ViewPitchMm: " << this->ViewPitchMm << endl;
  os << indent << "WiresAsVoxels: " << this->WiresAsVoxels << endl;
  os << indent << "WireEchoPerMm: " << this->WireEchoPerMm << endl;
  os << indent << "SphereDiameterMm: " << this->SphereDiameterMm << endl;
  os << indent << "SphereDepthMm: " << this->SphereDepthMm << endl;
}

int vtkSonoPhantomSource::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : "vtkPolyData");
  return 1;
}

sono::CalibrationPhantomSettings vtkSonoPhantomSource::CalibrationSettings() const
{
  return { this->SpacingMm, this->ThicknessMm, this->ViewPitchMm, this->WiresAsVoxels };
}

std::vector<sono::PhantomTarget> vtkSonoPhantomSource::Targets() const
{
  return sono::readPhantomTargets(sono::chosenOrBundled(this->TargetFile, "phantom_040gse.csv"));
}

std::shared_ptr<const sono::LabelVolume> vtkSonoPhantomSource::MakeVolume() const
{
  sono::requireInRange(this->Phantom >= Calibration && this->Phantom <= Neck, "phantom", this->Phantom,
                       "0 (calibration) to 5 (neck)");
  if (this->Phantom == Calibration)
  {
    return std::make_shared<const sono::LabelVolume>(
      sono::makeCalibrationPhantom(this->Targets(), this->CalibrationSettings()));
  }
  const auto object = static_cast<sono::TestObject>(this->Phantom - EnhancementSphere);
  return std::make_shared<const sono::LabelVolume>(
    sono::makeTestObject(object, { this->SpacingMm, this->SphereDiameterMm, this->SphereDepthMm }));
}

int vtkSonoPhantomSource::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    this->Volume = this->MakeVolume();
    sono::announceLabelImage(this->Volume->placement, output->GetInformationObject(0));
  });
}

int vtkSonoPhantomSource::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    const auto volume = this->Volume ? std::move(this->Volume) : this->MakeVolume();
    vtkImageData* image = vtkImageData::GetData(output);
    sono::imageFromLabelVolume(*volume, image);
    if (this->Phantom != Calibration)
    {
      writeView(1, sono::ProbePose{}, image->GetFieldData());
      return;
    }
    sono::requireInRange(this->WireEchoPerMm >= 0.0, "echo of the wires per mm", this->WireEchoPerMm, "0 or more");
    const sono::CalibrationPhantomSettings settings = this->CalibrationSettings();
    for (int view = 1; view <= sono::phantomViewCount; ++view)
    {
      writeView(view, sono::phantomViewPose(settings, view), image->GetFieldData());
    }
    const std::vector<sono::PhantomTarget> targets = this->Targets();
    const auto scatterers = sono::phantomWireScatterers(targets, settings, this->WireEchoPerMm);
    if (!this->WiresAsVoxels && !scatterers.empty())
    {
      const auto tissues = sono::TissueTable::read(sono::dataFile("tissues.csv"));
      writeSurface(sono::phantomWireSurface(targets, settings, tissues), vtkPolyData::GetData(output, 1));
      writeScatterers(scatterers, vtkPolyData::GetData(output, 2));
    }
  });
}
