#include "SonoProbeParts.h"

#include "SonoProbeHead.h"

#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkCommand.h"
#include "vtkCoordinate.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkMath.h"
#include "vtkPoints.h"
#include "vtkTextProperty.h"

#include <cmath>

namespace {

constexpr double ringBehindMm = 24.0;
constexpr double handleBehindMm = 62.0;
constexpr double handleAsideMm = 22.0;

using States = vtkSonoProbeRepresentation;

} // namespace

SonoColour sonoColourOf(int state)
{
  switch (state)
  {
    case States::ROTATING:
      return { 0.95, 0.75, 0.1 };
    case States::TILTING:
      return { 0.2, 0.8, 0.3 };
    case States::ROCKING:
      return { 0.3, 0.6, 1.0 };
    case States::DEEPENING:
      return { 0.85, 0.4, 0.9 };
    default:
      return { 0.85, 0.87, 0.9 };
  }
}

vtkSonoProbeRepresentation::Internals::Internals()
{
  vtkNew<vtkCallbackCommand>
    silence; // numbers are drawn while they are typed, with steps on the way that are not valid
  this->Probe->AddObserver(vtkCommand::ErrorEvent, silence);
  this->Probe->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, silence);
  this->Probe->SetPositionMm(0.0, 0.0, 0.0);
  this->Probe->SetAxial(0.0, 0.0, 1.0);
  this->Probe->SetLateral(1.0, 0.0, 0.0);

  vtkNew<vtkPolyData> nothing; // until there are numbers that are valid
  this->Head.Mapper->SetInputData(nothing);
  this->Frame.Mapper->SetInputData(nothing);
  this->Outline.Mapper->SetInputData(this->OutlineShape);
  this->Outline.SetColour({ 1.0, 0.9, 0.3 });
  this->Outline.Actor->GetProperty()->SetLineWidth(3.0);
  this->Frame.SetColour(sonoColourOf(ROTATING));
  this->Frame.Actor->GetProperty()->SetLineWidth(2.0);
  this->Marker.SetColour({ 0.9, 0.3, 0.1 });
  this->Head.SetColour(sonoColourOf(SLIDING));
  this->Head.Actor->GetProperty()->SetInterpolationToFlat();
  this->MarkerBall->SetRadius(3.0);
  this->Marker.Mapper->SetInputConnection(this->MarkerBall->GetOutputPort());
  this->Ball->SetRadius(1.0);
  this->Ball->SetThetaResolution(16);
  this->Ball->SetPhiResolution(16);
  for (int state : { ROTATING, TILTING, ROCKING, DEEPENING })
  {
    this->Handle(state).Mapper->SetInputConnection(this->Ball->GetOutputPort());
    this->Handle(state).SetColour(sonoColourOf(state));
    this->Handle(state).Actor->GetProperty()->SetAmbient(0.4);
  }
  for (SonoProbePart* part : { &this->Outline, &this->Frame, &this->Head, &this->Marker })
  {
    part->Actor->SetUserMatrix(this->Placement);
  }
  this->Text->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  this->Text->SetPosition(0.01, 0.015);
  this->Text->GetTextProperty()->SetFontSize(16);
  this->Text->GetTextProperty()->SetShadow(true);
}

vtkVector3d vtkSonoProbeRepresentation::Internals::RingPoint(int step) const
{
  const double angle = 2.0 * vtkMath::Pi() * step / RingSteps;
  return { this->RingMm() * std::cos(angle), this->RingMm() * std::sin(angle), -ringBehindMm };
}

void vtkSonoProbeRepresentation::Internals::UpdateShape()
{
  if (this->Probe->GetMTime() <= this->ShapeTime)
  {
    return;
  }
  this->Probe->SetPresetFile(this->PresetFile.c_str());
  this->Probe->Update();
  if (this->Probe->GetOutput()->GetNumberOfCells() == 0 && !this->PresetFile.empty())
  {
    this->Probe->SetPresetFile("");
    this->Probe->Update();
  }
  this->ShapeTime = this->Probe->GetMTime();
  vtkPolyData* outline = this->Probe->GetOutput();
  if (outline->GetNumberOfCells() < 2)
  {
    return; // numbers that are not valid (yet): the last good ones stay drawn
  }
  this->OutlineShape->ShallowCopy(outline);
  const SonoProbeHead head(outline);
  this->Head.Mapper->SetInputData(head.surface);
  this->HalfWidthMm = head.halfWidthMm;
  this->CatheterMm = head.radialMm;
  this->DrawnDepthMm = outline->GetFieldData()->GetArray("DepthMm")->GetTuple1(0);
  this->MarkerBall->SetCenter(head.halfWidthMm + 1.0, 0.0, head.radialMm > 0.0 ? 0.0 : -10.0);

  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(RingSteps + 1);
  for (int step = 0; step <= RingSteps; ++step)
  {
    lines->InsertCellPoint(points->InsertNextPoint(this->RingPoint(step).GetData()));
  }
  for (const vtkVector3d& end :
       { vtkVector3d(handleAsideMm, 0.0, -handleBehindMm), vtkVector3d(0.0, handleAsideMm, -handleBehindMm) })
  {
    const vtkIdType from = points->InsertNextPoint(0.0, 0.0, -handleBehindMm);
    lines->InsertNextCell({ from, points->InsertNextPoint(end.GetData()) });
  }
  vtkNew<vtkPolyData> frame;
  frame->SetPoints(points);
  frame->SetLines(lines);
  this->Frame.Mapper->SetInputData(frame);
}

vtkVector3d vtkSonoProbeRepresentation::Internals::HandlePlace(int state)
{
  this->UpdateShape();
  vtkVector3d place(0.0, 0.0, -0.5 * ringBehindMm);
  switch (state)
  {
    case ROTATING:
      place = this->RingPoint(0);
      break;
    case TILTING:
      place = { 0.0, handleAsideMm, -handleBehindMm };
      break;
    case ROCKING:
      place = { handleAsideMm, 0.0, -handleBehindMm };
      break;
    case DEEPENING:
      place = { 0.0, 0.0, this->CatheterMm + this->DrawnDepthMm };
      break;
    default:
      break;
  }
  return place;
}
