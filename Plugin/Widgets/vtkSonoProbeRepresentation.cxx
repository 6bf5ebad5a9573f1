#include "vtkSonoProbeRepresentation.h"

#include "SonoProbeHead.h"
#include "SonoProbePose.h"
#include "vtkSonoProbeSource.h"
#include "vtkSonoSkin.h"

#include "vtkActor.h"
#include "vtkBoundingBox.h"
#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkInteractorObserver.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkPropCollection.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkTextActor.h"
#include "vtkTextProperty.h"
#include "vtkVectorOperators.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>

vtkStandardNewMacro(vtkSonoProbeRepresentation);

namespace {

constexpr double ringBehindMm = 24.0;
constexpr double handleBehindMm = 62.0;
constexpr double handleAsideMm = 22.0;
constexpr double handlePixels = 7.0;
constexpr double grabPixels = 10.0;
constexpr int ringSteps = 72;
constexpr double touchMm = 10.0; // a face this near to the skin stands on it
constexpr double leastDepthMm = 1.0;
constexpr double mostDepthMm = 1000.0;

const char* const offSkin = "That is off the skin: the probe stays where it last stood.";
const char* const noSkin = "No surface is shown here that the probe could stand on: show the Ultrasound Scene.";

using States = vtkSonoProbeRepresentation;

struct Colour
{
  double r, g, b;
};

Colour colourOf(int state)
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

const char* hintOf(int state)
{
  switch (state)
  {
    case States::SLIDING:
      return "Drag along the skin; arrow keys: 1 mm";
    case States::ROTATING:
      return "Rotate about the axis; Ctrl + left, right: 2 degrees";
    case States::TILTING:
      return "Tilt out of the image plane; Shift + up, down: 2 degrees";
    case States::ROCKING:
      return "Rock in the image plane; Shift + left, right: 2 degrees";
    case States::DEEPENING:
      return "Depth; Ctrl + up, down: 5 mm";
    default:
      return "";
  }
}

std::string signedNumber(const char* what, double value, const char* unit)
{
  std::ostringstream text;
  text << what << " " << std::showpos << std::fixed << std::setprecision(1) << value << " " << unit;
  return text.str();
}

/// A part of the picture.
struct Part
{
  Part() { this->Actor->SetMapper(this->Mapper); }
  void SetColour(const Colour& c) { this->Actor->GetProperty()->SetColor(c.r, c.g, c.b); }
  vtkNew<vtkPolyDataMapper> Mapper;
  vtkNew<vtkActor> Actor;
};

} // namespace

class vtkSonoProbeRepresentation::Internals
{
public:
  Internals()
  {
    vtkNew<vtkCallbackCommand>
      silence; // numbers are drawn while they are typed, with steps on the way that are not valid
    this->Probe->AddObserver(vtkCommand::ErrorEvent, silence);
    this->Probe->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, silence);
    this->Probe->SetPositionMm(0.0, 0.0, 0.0);
    this->Probe->SetAxial(0.0, 0.0, 1.0);
    this->Probe->SetLateral(1.0, 0.0, 0.0);

    this->Outline.Mapper->SetInputData(this->OutlineShape);
    this->Outline.SetColour({ 1.0, 0.9, 0.3 });
    this->Outline.Actor->GetProperty()->SetLineWidth(3.0);
    this->Frame.SetColour(colourOf(ROTATING));
    this->Frame.Actor->GetProperty()->SetLineWidth(2.0);
    this->Marker.SetColour({ 0.9, 0.3, 0.1 });
    this->Head.SetColour(colourOf(SLIDING));
    this->Head.Actor->GetProperty()->SetInterpolationToFlat();
    this->MarkerBall->SetRadius(3.0);
    this->Marker.Mapper->SetInputConnection(this->MarkerBall->GetOutputPort());
    this->Ball->SetRadius(1.0);
    this->Ball->SetThetaResolution(16);
    this->Ball->SetPhiResolution(16);
    for (int state : { ROTATING, TILTING, ROCKING, DEEPENING })
    {
      this->Handle(state).Mapper->SetInputConnection(this->Ball->GetOutputPort());
      this->Handle(state).SetColour(colourOf(state));
      this->Handle(state).Actor->GetProperty()->SetAmbient(0.4);
    }
    for (Part* part : { &this->Outline, &this->Frame, &this->Head, &this->Marker })
    {
      part->Actor->SetUserMatrix(this->Placement);
    }
    this->Text->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
    this->Text->SetPosition(0.01, 0.015);
    this->Text->GetTextProperty()->SetFontSize(16);
    this->Text->GetTextProperty()->SetShadow(true);
  }

  Part& Handle(int state) { return this->Handles[static_cast<std::size_t>(state - ROTATING)]; }

  template<typename Work>
  void ForEachActor(const Work& work)
  {
    for (Part* part : { &this->Outline, &this->Frame, &this->Head, &this->Marker })
    {
      work(part->Actor.Get());
    }
    for (Part& part : this->Handles)
    {
      work(part.Actor.Get());
    }
  }

  vtkNew<vtkSonoProbeSource> Probe; // in its own frame: (lateral, elevational, axial)
  std::string PresetFile;
  vtkMTimeType ShapeTime = 0;
  double DrawnDepthMm = 0.0; // of the preset, where there is one
  double HalfWidthMm = 10.0;
  double CatheterMm = 0.0;

  vtkNew<vtkSonoSkin> Skin;
  vtkNew<vtkPolyData> OutlineShape;
  vtkNew<vtkMatrix4x4> Placement;
  vtkNew<vtkSphereSource> Ball;
  vtkNew<vtkSphereSource> MarkerBall;
  Part Outline;
  Part Frame;
  Part Head;
  Part Marker;
  std::array<Part, 4> Handles;
  vtkNew<vtkTextActor> Text;
  double Bounds[6];

  // Of the movement that is under way.
  vtkVector3d Grip{ 0.0 }; // the grabbed point in the probe's frame
  vtkVector2d Offset{ 0.0 };
  double Moved = 0.0;
  bool Stands = false; // on the skin, with this normal
  vtkVector3d Outward{ 0.0 };
  int Hovered = OUTSIDE;
};

namespace {

/// Projections of one renderer.
class Display
{
public:
  explicit Display(vtkRenderer* renderer)
    : Renderer(renderer)
  {
  }
  vtkVector2d of(const vtkVector3d& world) const
  {
    double display[3];
    vtkInteractorObserver::ComputeWorldToDisplay(this->Renderer, world[0], world[1], world[2], display);
    return { display[0], display[1] };
  }
  vtkVector3d worldAt(double x, double y, double z) const
  {
    double world[4];
    vtkInteractorObserver::ComputeDisplayToWorld(this->Renderer, x, y, z, world);
    return vtkVector3d(world);
  }
  double mmPerPixel(const vtkVector3d& world) const
  {
    double display[3];
    vtkInteractorObserver::ComputeWorldToDisplay(this->Renderer, world[0], world[1], world[2], display);
    const vtkVector3d beside = this->worldAt(display[0] + 1.0, display[1], display[2]);
    return (beside - this->worldAt(display[0], display[1], display[2])).Norm();
  }

private:
  vtkRenderer* Renderer;
};

double distanceToSegment(const vtkVector2d& p, const vtkVector2d& a, const vtkVector2d& b)
{
  const vtkVector2d way = b - a;
  const double length2 = way.Dot(way);
  const double t = length2 > 0.0 ? std::clamp((p - a).Dot(way) / length2, 0.0, 1.0) : 0.0;
  return (p - a - way * t).Norm();
}

vtkVector3d ringPoint(double radius, int step)
{
  const double angle = 2.0 * vtkMath::Pi() * step / ringSteps;
  return { radius * std::cos(angle), radius * std::sin(angle), -ringBehindMm };
}

} // namespace

vtkSonoProbeRepresentation::vtkSonoProbeRepresentation()
  : Parts(new Internals)
{
  vtkNew<vtkSonoProbeSource> defaults;
  defaults->GetPositionMm(this->PositionMm);
  defaults->GetAxial(this->Axial);
  defaults->GetLateral(this->Lateral);
  this->InteractionState = OUTSIDE;
  this->PickableOff();
}

vtkSonoProbeRepresentation::~vtkSonoProbeRepresentation() = default;

void vtkSonoProbeRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto printVector = [&](const char* name, const double* v) {
    os << indent << name << ": " << v[0] << " " << v[1] << " " << v[2] << endl;
  };
  printVector("PositionMm", this->PositionMm);
  printVector("Axial", this->Axial);
  printVector("Lateral", this->Lateral);
  os << indent << "Message: " << this->Message << endl;
  this->Parts->Probe->PrintSelf(os, indent.GetNextIndent());
}

#define sonoForward(Type, Name)                                                                                        \
  void vtkSonoProbeRepresentation::Set##Name(Type value)                                                               \
  {                                                                                                                    \
    if (this->Parts->Probe->Get##Name() != value)                                                                      \
    {                                                                                                                  \
      this->Parts->Probe->Set##Name(value);                                                                            \
      this->Modified();                                                                                                \
    }                                                                                                                  \
  }                                                                                                                    \
  Type vtkSonoProbeRepresentation::Get##Name()                                                                         \
  {                                                                                                                    \
    return this->Parts->Probe->Get##Name();                                                                            \
  }
sonoForward(int, ScanKind);
sonoForward(int, LineCount);
sonoForward(double, DepthMm);
sonoForward(double, SectorDeg);
sonoForward(double, RadiusMm);
sonoForward(double, WidthMm);
sonoForward(int, ElevationLineCount);
sonoForward(double, ElevationSectorDeg);
#undef sonoForward

void vtkSonoProbeRepresentation::SetPresetFile(const char* path)
{
  const std::string next = path ? path : "";
  if (next != this->Parts->PresetFile)
  {
    this->Parts->PresetFile = next;
    this->Parts->Probe->Modified();
    this->Modified();
  }
}

const char* vtkSonoProbeRepresentation::GetPresetFile()
{
  return this->Parts->PresetFile.c_str();
}

vtkSonoSkin* vtkSonoProbeRepresentation::GetSkin()
{
  return this->Parts->Skin;
}

SonoProbePose vtkSonoProbeRepresentation::Pose() const
{
  return SonoProbePose::from(this->PositionMm, this->Axial, this->Lateral);
}

void vtkSonoProbeRepresentation::SetPose(const SonoProbePose& pose)
{
  this->SetPositionMm(pose.positionMm[0], pose.positionMm[1], pose.positionMm[2]);
  this->SetAxial(pose.axial[0], pose.axial[1], pose.axial[2]);
  this->SetLateral(pose.lateral[0], pose.lateral[1], pose.lateral[2]);
}

void vtkSonoProbeRepresentation::Rotate(double degrees)
{
  SonoProbePose pose = this->Pose();
  pose.rotate(degrees);
  this->SetPose(pose);
  this->Message = signedNumber("Rotate", degrees, "degrees");
}

void vtkSonoProbeRepresentation::Tilt(double degrees)
{
  SonoProbePose pose = this->Pose();
  pose.tilt(degrees);
  this->SetPose(pose);
  this->Message = signedNumber("Tilt", degrees, "degrees");
}

void vtkSonoProbeRepresentation::Rock(double degrees)
{
  SonoProbePose pose = this->Pose();
  pose.rock(degrees);
  this->SetPose(pose);
  this->Message = signedNumber("Rock", degrees, "degrees");
}

void vtkSonoProbeRepresentation::ChangeDepth(double mm)
{
  if (!this->Parts->PresetFile.empty())
  {
    this->Message = "The preset file gives the depth: clear it to choose another.";
    return;
  }
  this->SetDepthMm(std::clamp(this->GetDepthMm() + mm, leastDepthMm, mostDepthMm));
  std::ostringstream text;
  text << "Depth " << std::fixed << std::setprecision(0) << this->GetDepthMm() << " mm";
  this->Message = text.str();
}

void vtkSonoProbeRepresentation::FindSkin()
{
  const SonoProbePose pose = this->Pose();
  const vtkVector3d before = pose.world(0.0, 0.0, -touchMm);
  const vtkVector3d behind = pose.world(0.0, 0.0, touchMm);
  double place[3];
  this->Parts->Stands =
    this->Parts->Skin->Meet(before.GetData(), behind.GetData(), place, this->Parts->Outward.GetData());
}

void vtkSonoProbeRepresentation::StandOn(const double place[3], const double outward[3])
{
  this->FindSkin();
  SonoProbePose pose = this->Pose();
  const vtkVector3d normal = vtkVector3d(outward).Normalized();
  pose.carry(this->Parts->Stands ? this->Parts->Outward : pose.axial * -1.0, normal);
  pose.positionMm = vtkVector3d(place);
  this->SetPose(pose);
  this->Message.clear();
}

bool vtkSonoProbeRepresentation::Walk(double lateralMm, double elevationMm)
{
  if (this->Parts->Skin->IsEmpty())
  {
    this->Message = noSkin;
    return false;
  }
  this->FindSkin();
  const SonoProbePose pose = this->Pose();
  const vtkVector3d normal = this->Parts->Stands ? this->Parts->Outward : pose.axial * -1.0;
  // Along the skin, also where the probe is tilted; a length of its own for each step, however steep.
  const vtkVector3d step = pose.lateral * lateralMm + pose.elevation() * elevationMm;
  vtkVector3d along = step - normal * normal.Dot(step);
  along = along.Norm() > 0.0 ? along.Normalized() * step.Norm() : along;
  const vtkVector3d above = pose.positionMm + along + normal * touchMm;
  const vtkVector3d below = pose.positionMm + along - normal * touchMm;
  double place[3];
  double outward[3];
  if (!this->Parts->Skin->Meet(above.GetData(), below.GetData(), place, outward))
  {
    this->Message = offSkin;
    return false;
  }
  this->StandOn(place, outward);
  return true;
}

bool vtkSonoProbeRepresentation::SnapToSkin()
{
  vtkSonoSkin* skin = this->Parts->Skin;
  if (skin->IsEmpty())
  {
    this->Message = noSkin;
    return false;
  }
  SonoProbePose pose = this->Pose();
  vtkBoundingBox box;
  double bounds[6];
  skin->GetBounds(bounds);
  box.AddBounds(bounds);
  box.AddPoint(pose.positionMm.GetData());
  const double farMm = box.GetDiagonalLength() + 1.0;
  double place[3];
  vtkVector3d outward;
  if (!skin->Meet(pose.world(0.0, 0.0, -farMm).GetData(), pose.world(0.0, 0.0, farMm).GetData(), place,
                  outward.GetData()))
  {
    skin->FindNearest(this->PositionMm, place, outward.GetData());
  }
  pose.positionMm = vtkVector3d(place);
  pose.carry(pose.axial * -1.0, outward);
  this->SetPose(pose);
  this->Message.clear();
  return true;
}

void vtkSonoProbeRepresentation::UpdateShape()
{
  Internals& parts = *this->Parts;
  if (parts.Probe->GetMTime() <= parts.ShapeTime)
  {
    return;
  }
  parts.Probe->SetPresetFile(parts.PresetFile.c_str());
  parts.Probe->Update();
  if (parts.Probe->GetOutput()->GetNumberOfCells() == 0 && !parts.PresetFile.empty())
  {
    parts.Probe->SetPresetFile("");
    parts.Probe->Update();
  }
  parts.ShapeTime = parts.Probe->GetMTime();
  vtkPolyData* outline = parts.Probe->GetOutput();
  if (outline->GetNumberOfCells() < 2)
  {
    return; // numbers that are not valid (yet): the last good ones stay drawn
  }
  parts.OutlineShape->ShallowCopy(outline);
  const SonoProbeHead head(outline);
  parts.Head.Mapper->SetInputData(head.surface);
  parts.HalfWidthMm = head.halfWidthMm;
  parts.CatheterMm = head.radialMm;
  parts.DrawnDepthMm = outline->GetFieldData()->GetArray("DepthMm")->GetTuple1(0);
  parts.MarkerBall->SetCenter(head.halfWidthMm + 1.0, 0.0, head.radialMm > 0.0 ? 0.0 : -10.0);

  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  const double radius = head.halfWidthMm + 14.0;
  lines->InsertNextCell(ringSteps + 1);
  for (int step = 0; step <= ringSteps; ++step)
  {
    lines->InsertCellPoint(points->InsertNextPoint(ringPoint(radius, step).GetData()));
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
  parts.Frame.Mapper->SetInputData(frame);
}

void vtkSonoProbeRepresentation::GetHandle(int state, double world[3])
{
  this->UpdateShape();
  vtkVector3d place(0.0, 0.0, -0.5 * ringBehindMm);
  switch (state)
  {
    case ROTATING:
      place = ringPoint(this->Parts->HalfWidthMm + 14.0, 0);
      break;
    case TILTING:
      place = { 0.0, handleAsideMm, -handleBehindMm };
      break;
    case ROCKING:
      place = { handleAsideMm, 0.0, -handleBehindMm };
      break;
    case DEEPENING:
      place = { 0.0, 0.0, this->Parts->CatheterMm + this->Parts->DrawnDepthMm };
      break;
    default:
      break;
  }
  const vtkVector3d at = this->Pose().world(place[0], place[1], place[2]);
  std::copy(at.GetData(), at.GetData() + 3, world);
}

int vtkSonoProbeRepresentation::ComputeInteractionState(int x, int y, int)
{
  this->InteractionState = OUTSIDE;
  if (!this->Renderer)
  {
    return OUTSIDE;
  }
  const Display display(this->Renderer);
  const vtkVector2d mouse(x, y);
  const SonoProbePose pose = this->Pose();
  double nearest = grabPixels;
  for (int state : { TILTING, ROCKING, DEEPENING, ROTATING })
  {
    vtkVector3d handle;
    this->GetHandle(state, handle.GetData());
    const double distance = (display.of(handle) - mouse).Norm();
    if (distance <= nearest && (state != DEEPENING || this->Parts->PresetFile.empty()))
    {
      nearest = distance;
      this->InteractionState = state;
    }
  }
  const auto at = [&](const vtkVector3d& p) { return display.of(pose.world(p[0], p[1], p[2])); };
  if (this->InteractionState == OUTSIDE)
  {
    const double pixels = 0.7 * this->Parts->HalfWidthMm / display.mmPerPixel(pose.positionMm);
    const double distance =
      distanceToSegment(mouse, at({ 0.0, 0.0, -2.0 }), at({ 0.0, 0.0, 8.0 - SonoProbeHead::tailMm }));
    this->InteractionState = distance <= std::max(pixels, 0.8 * grabPixels) ? SLIDING : OUTSIDE;
  }
  for (int step = 0; this->InteractionState == OUTSIDE && step < ringSteps; ++step)
  {
    const double radius = this->Parts->HalfWidthMm + 14.0;
    const double distance = distanceToSegment(mouse, at(ringPoint(radius, step)), at(ringPoint(radius, step + 1)));
    this->InteractionState = distance <= 0.6 * grabPixels ? ROTATING : OUTSIDE;
  }
  return this->InteractionState;
}

void vtkSonoProbeRepresentation::StartWidgetInteraction(double eventPosition[2])
{
  Internals& parts = *this->Parts;
  const Display display(this->Renderer);
  const SonoProbePose pose = this->Pose();
  const vtkVector2d mouse(eventPosition);
  vtkVector3d grabbed = pose.positionMm; // sliding moves the middle of the face
  if (this->InteractionState != SLIDING)
  {
    this->GetHandle(this->InteractionState, grabbed.GetData());
  }
  const vtkVector3d from = grabbed - pose.positionMm;
  parts.Grip = { from.Dot(pose.lateral), from.Dot(pose.elevation()), from.Dot(pose.axial) };
  if (this->InteractionState == ROTATING)
  {
    // Anywhere on the ring.
    double nearest = VTK_DOUBLE_MAX;
    for (int step = 0; step < ringSteps; ++step)
    {
      const vtkVector3d p = ringPoint(parts.HalfWidthMm + 14.0, step);
      const double distance = (display.of(pose.world(p[0], p[1], p[2])) - mouse).Norm();
      if (distance < nearest)
      {
        nearest = distance;
        parts.Grip = p;
      }
    }
  }
  parts.Offset = mouse - display.of(pose.world(parts.Grip[0], parts.Grip[1], parts.Grip[2]));
  parts.Moved = 0.0;
}

void vtkSonoProbeRepresentation::WidgetInteraction(double eventPosition[2])
{
  if (this->InteractionState == SLIDING)
  {
    this->Slide(eventPosition);
  }
  else if (this->InteractionState != OUTSIDE)
  {
    this->FollowWithHandle(eventPosition);
  }
}

void vtkSonoProbeRepresentation::EndWidgetInteraction(double[2])
{
  this->InteractionState = OUTSIDE;
}

void vtkSonoProbeRepresentation::Slide(const double eventPosition[2])
{
  const Display display(this->Renderer);
  const vtkVector2d aim = vtkVector2d(eventPosition) - this->Parts->Offset;
  const vtkVector3d front = display.worldAt(aim[0], aim[1], 0.0);
  const vtkVector3d back = display.worldAt(aim[0], aim[1], 1.0);
  double place[3];
  double outward[3];
  if (this->Parts->Skin->Meet(front.GetData(), back.GetData(), place, outward))
  {
    this->StandOn(place, outward);
  }
  else
  {
    this->Message = this->Parts->Skin->IsEmpty() ? noSkin : offSkin;
    this->Modified();
  }
}

void vtkSonoProbeRepresentation::FollowWithHandle(const double eventPosition[2])
{
  Internals& parts = *this->Parts;
  const Display display(this->Renderer);
  const vtkVector2d aim = vtkVector2d(eventPosition) - parts.Offset;
  // Newton's steps until the handle is under the pointer.
  for (int step = 0; step < 8; ++step)
  {
    const SonoProbePose pose = this->Pose();
    const vtkVector3d handle = pose.world(parts.Grip[0], parts.Grip[1], parts.Grip[2]);
    const vtkVector3d arm = handle - pose.positionMm;
    vtkVector3d speed = pose.axial; // mm per radian or mm
    switch (this->InteractionState)
    {
      case ROTATING:
        speed = pose.axial.Cross(arm);
        break;
      case TILTING:
        speed = pose.lateral.Cross(arm) * -1.0;
        break;
      case ROCKING:
        speed = pose.elevation().Cross(arm);
        break;
      default:
        break;
    }
    constexpr double little = 1e-3;
    const vtkVector2d onScreen = (display.of(handle + speed * little) - display.of(handle)) * (1.0 / little);
    // A movement towards the eye shows as none; it is then not made faster and faster.
    const double least = 0.2 * speed.Norm() / display.mmPerPixel(handle);
    double change = (aim - display.of(handle)).Dot(onScreen) / std::max(onScreen.Dot(onScreen), least * least);
    if (this->InteractionState == DEEPENING)
    {
      const double before = this->GetDepthMm();
      this->ChangeDepth(change);
      change = this->GetDepthMm() - before;
      parts.Grip[2] += change;
    }
    else
    {
      change = std::clamp(vtkMath::DegreesFromRadians(change), -20.0, 20.0);
      parts.Moved += change;
      switch (this->InteractionState)
      {
        case ROTATING:
          this->Rotate(change);
          this->Message = signedNumber("Rotate", parts.Moved, "degrees");
          break;
        case TILTING:
          this->Tilt(change);
          this->Message = signedNumber("Tilt", parts.Moved, "degrees");
          break;
        default:
          this->Rock(change);
          this->Message = signedNumber("Rock", parts.Moved, "degrees");
          break;
      }
    }
    if (std::abs(change) < 1e-3)
    {
      break;
    }
  }
}

void vtkSonoProbeRepresentation::Highlight(int on)
{
  const int hovered = on ? this->InteractionState : static_cast<int>(OUTSIDE);
  if (hovered == this->Parts->Hovered)
  {
    return;
  }
  this->Parts->Hovered = hovered;
  this->Message = hintOf(hovered);
  const Colour bright{ 1.0, 1.0, 1.0 };
  for (int state : { ROTATING, TILTING, ROCKING, DEEPENING })
  {
    this->Parts->Handle(state).SetColour(state == hovered ? bright : colourOf(state));
  }
  this->Parts->Head.SetColour(hovered == SLIDING ? bright : colourOf(SLIDING));
  this->Modified();
}

void vtkSonoProbeRepresentation::BuildRepresentation()
{
  this->UpdateShape();
  Internals& parts = *this->Parts;
  const SonoProbePose pose = this->Pose();
  const vtkVector3d elevation = pose.elevation();
  for (int row = 0; row < 3; ++row)
  {
    parts.Placement->SetElement(row, 0, pose.lateral[row]);
    parts.Placement->SetElement(row, 1, elevation[row]);
    parts.Placement->SetElement(row, 2, pose.axial[row]);
    parts.Placement->SetElement(row, 3, pose.positionMm[row]);
  }
  for (int state : { ROTATING, TILTING, ROCKING, DEEPENING })
  {
    vtkVector3d place;
    this->GetHandle(state, place.GetData());
    vtkActor* actor = parts.Handle(state).Actor;
    actor->SetPosition(place.GetData());
    actor->SetScale(this->Renderer ? handlePixels * Display(this->Renderer).mmPerPixel(place) : 3.0);
  }
  parts.Handle(DEEPENING).Actor->SetVisibility(parts.PresetFile.empty());
  parts.Text->SetInput(this->Message.c_str());
  this->BuildTime.Modified();
}

double* vtkSonoProbeRepresentation::GetBounds()
{
  this->BuildRepresentation();
  vtkBoundingBox box;
  this->Parts->ForEachActor([&](vtkActor* actor) {
    if (const double* bounds = actor->GetBounds())
    {
      box.AddBounds(bounds);
    }
  });
  box.GetBounds(this->Parts->Bounds);
  return this->Parts->Bounds;
}

void vtkSonoProbeRepresentation::GetActors(vtkPropCollection* actors)
{
  this->Parts->ForEachActor([&](vtkActor* actor) { actor->GetActors(actors); });
}

void vtkSonoProbeRepresentation::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Parts->ForEachActor([&](vtkActor* actor) { actor->ReleaseGraphicsResources(window); });
  this->Parts->Text->ReleaseGraphicsResources(window);
}

int vtkSonoProbeRepresentation::RenderOpaqueGeometry(vtkViewport* viewport)
{
  this->BuildRepresentation();
  int drawn = 0;
  this->Parts->ForEachActor([&](vtkActor* actor) {
    if (actor->GetVisibility())
    {
      drawn += actor->RenderOpaqueGeometry(viewport);
    }
  });
  if (!this->Message.empty())
  {
    this->Parts->Text->RenderOpaqueGeometry(viewport); // prepares what the overlay draws
  }
  return drawn;
}

int vtkSonoProbeRepresentation::RenderOverlay(vtkViewport* viewport)
{
  return this->Message.empty() ? 0 : this->Parts->Text->RenderOverlay(viewport);
}
