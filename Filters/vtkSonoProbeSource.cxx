#include "vtkSonoProbeSource.h"

#include "Progress.h"
#include "SonoProbeField.h"
#include "SonoStage.h"

#include "vtkCellArray.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

vtkStandardNewMacro(vtkSonoProbeSource);

namespace {

/// Draws lines of constant depth and constant line number in the world.
class Outline
{
public:
  explicit Outline(const sono::ProbeField& probe)
    : probe_(probe)
  {
  }

  void beginCell() { first_ = this->points->GetNumberOfPoints(); }

  void addPoint(double line, double depthMm)
  {
    const sono::Vec2f plane = sono::planeFromBeam(probe_.geometry, line, depthMm);
    const sono::Vec3d world =
      probe_.pose.positionMm + double(plane.x) * probe_.pose.lateral + double(plane.y) * probe_.pose.axial;
    this->points->InsertNextPoint(&world.x);
  }

  /// Along the scan lines' near ends (or far ends) from line `from` to line `to`.
  void addArc(double from, double to, double depthMm)
  {
    constexpr int steps = 64;
    for (int i = 0; i <= steps; ++i)
    {
      this->addPoint(from + (to - from) * i / steps, depthMm);
    }
  }

  void endCell(bool closed)
  {
    const vtkIdType count = this->points->GetNumberOfPoints() - first_;
    this->lines->InsertNextCell(static_cast<int>(count) + (closed ? 1 : 0));
    for (vtkIdType i = 0; i < count; ++i)
    {
      this->lines->InsertCellPoint(first_ + i);
    }
    if (closed)
    {
      this->lines->InsertCellPoint(first_);
    }
  }

  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;

private:
  const sono::ProbeField& probe_;
  vtkIdType first_ = 0;
};

} // namespace

vtkSonoProbeSource::vtkSonoProbeSource()
{
  this->SetNumberOfInputPorts(0);
}

vtkSonoProbeSource::~vtkSonoProbeSource() = default;

void vtkSonoProbeSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto printVector = [&](const char* name, const double* v) {
    os << indent << name << ": " << v[0] << " " << v[1] << " " << v[2] << endl;
  };
  os << indent << "PresetFile: " << this->PresetFile << endl;
  os << indent << "ScanKind: " << this->ScanKind << endl;
  os << indent << "LineCount: " << this->LineCount << endl;
  os << indent << "DepthMm: " << this->DepthMm << endl;
  os << indent << "SectorDeg: " << this->SectorDeg << endl;
  os << indent << "RadiusMm: " << this->RadiusMm << endl;
  os << indent << "WidthMm: " << this->WidthMm << endl;
  printVector("PositionMm", this->PositionMm);
  printVector("Axial", this->Axial);
  printVector("Lateral", this->Lateral);
  os << indent << "CentreFrequencyMHz: " << this->CentreFrequencyMHz << endl;
  os << indent << "FractionalBandwidth: " << this->FractionalBandwidth << endl;
}

sono::ProbeField vtkSonoProbeSource::Probe() const
{
  sono::ProbeField probe;
  if (this->PresetFile.empty())
  {
    if (this->ScanKind < LINEAR || this->ScanKind > CURVILINEAR)
    {
      throw sono::Error("ScanKind is " + std::to_string(this->ScanKind) +
                        " but must be 0 (linear), 1 (phased sector) or 2 (curvilinear).");
    }
    probe.geometry = { static_cast<sono::ScanKind>(this->ScanKind),
                       this->LineCount,
                       this->DepthMm,
                       this->SectorDeg,
                       this->RadiusMm,
                       this->WidthMm };
    probe.centreFrequencyMHz = this->CentreFrequencyMHz;
    probe.fractionalBandwidth = this->FractionalBandwidth;
  }
  else
  {
    const sono::ProbePreset preset = sono::readProbePreset(this->PresetFile);
    probe.geometry = preset.geometry;
    probe.centreFrequencyMHz = preset.centreFrequencyMHz;
    probe.fractionalBandwidth = preset.fractionalBandwidth;
  }
  probe.geometry.validate();

  const auto vector = [](const double* v) { return sono::Vec3d(v[0], v[1], v[2]); };
  const sono::ProbePose pose{ vector(this->PositionMm), vector(this->Axial), vector(this->Lateral) };
  probe.pose = pose.orthonormalized();
  return probe;
}

int vtkSonoProbeSource::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    vtkNew<vtkFieldData> field;
    sono::writeProbe(this->Probe(), field);
    sono::announceFields(field, output->GetInformationObject(0));
  });
}

int vtkSonoProbeSource::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    const sono::ProbeField probe = this->Probe();
    const double lastLine = probe.geometry.lineCount - 1;
    Outline outline(probe);
    outline.beginCell();
    outline.addArc(0.0, lastLine, probe.geometry.depthMm);
    outline.addArc(lastLine, 0.0, 0.0);
    outline.endCell(true);
    outline.beginCell();
    outline.addArc(0.0, lastLine, 0.0);
    outline.endCell(false);

    vtkPolyData* polyData = vtkPolyData::GetData(output);
    polyData->SetPoints(outline.points);
    polyData->SetLines(outline.lines);
    sono::writeProbe(probe, polyData->GetFieldData());
  });
}
