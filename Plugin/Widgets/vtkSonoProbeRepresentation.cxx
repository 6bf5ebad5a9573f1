#include "vtkSonoProbeRepresentation.h"

#include "SonoDisplay.h"
#include "SonoProbeParts.h"
#include "SonoProbePose.h"
#include "SonoProbeTexts.h"

#include "vtkBoundingBox.h"
#include "vtkObjectFactory.h"
#include "vtkPropCollection.h"
#include "vtkTextRenderer.h"
#include "vtkVectorOperators.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

vtkStandardNewMacro(vtkSonoProbeRepresentation);

namespace {

constexpr double handlePixels = 7.0;
constexpr double touchMm = 10.0; // a face this near to the skin stands on it
constexpr double leastDepthMm = 1.0;
constexpr double mostDepthMm = 1000.0;
constexpr double textPart = 0.97; // of a view's width that a message may take

using States = vtkSonoProbeRepresentation;

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

void vtkSonoProbeRepresentation::SetNumber(const char* name, double value)
{
  const vtkMTimeType before = this->Parts->Probe->GetMTime();
  this->Parts->Probe->SetNumber(name, value);
  if (this->Parts->Probe->GetMTime() != before)
  {
    this->Message.clear(); // it tells of other numbers
    this->Modified();
  }
}

void vtkSonoProbeRepresentation::SetDepthMm(double depth)
{
  this->SetNumber("DepthMm", depth);
}

double vtkSonoProbeRepresentation::GetDepthMm()
{
  return this->Parts->Probe->GetDepthMm();
}

void vtkSonoProbeRepresentation::SetPresetFile(const char* path)
{
  const std::string next = path ? path : "";
  if (next != this->Parts->PresetFile)
  {
    this->Parts->PresetFile = next;
    this->Message.clear();
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
  this->Message = sonoSignedNumber("Rotate", degrees, "degrees");
}

void vtkSonoProbeRepresentation::Tilt(double degrees)
{
  SonoProbePose pose = this->Pose();
  pose.tilt(degrees);
  this->SetPose(pose);
  this->Message = sonoSignedNumber("Tilt", degrees, "degrees");
}

void vtkSonoProbeRepresentation::Rock(double degrees)
{
  SonoProbePose pose = this->Pose();
  pose.rock(degrees);
  this->SetPose(pose);
  this->Message = sonoSignedNumber("Rock", degrees, "degrees");
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
    this->Message = sonoNoSkin;
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
    this->Message = sonoOffSkin;
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
    this->Message = sonoNoSkin;
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

void vtkSonoProbeRepresentation::GetHandle(int state, double world[3])
{
  const vtkVector3d place = this->Parts->HandlePlace(state);
  const vtkVector3d at = this->Pose().world(place[0], place[1], place[2]);
  std::copy(at.GetData(), at.GetData() + 3, world);
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
  const SonoColour bright{ 1.0, 1.0, 1.0 };
  for (int state : { ROTATING, TILTING, ROCKING, DEEPENING })
  {
    this->Parts->Handle(state).SetColour(state == hovered ? bright : sonoColourOf(state));
  }
  this->Parts->Head.SetColour(hovered == SLIDING ? bright : sonoColourOf(SLIDING));
  this->Modified();
}

std::string vtkSonoProbeRepresentation::GetMessageLines(int widthPixels)
{
  constexpr int dotsPerInch = 72; // so that a font's points are pixels, as vtkTextActor draws them
  const auto fits = [&](const std::string& line) {
    int box[4];
    vtkTextRenderer::GetInstance()->GetBoundingBox(this->Parts->Text->GetTextProperty(), line, box, dotsPerInch);
    return box[1] - box[0] < textPart * widthPixels;
  };
  std::istringstream words(this->Message);
  std::string lines;
  std::string line;
  for (std::string word; words >> word;)
  {
    const std::string longer = line.empty() ? word : line + " " + word;
    if (!line.empty() && !fits(longer))
    {
      lines += line + "\n";
      line = word;
      continue;
    }
    line = longer;
  }
  return lines + line;
}

void vtkSonoProbeRepresentation::BuildRepresentation()
{
  Internals& parts = *this->Parts;
  parts.UpdateShape();
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
    actor->SetScale(this->Renderer ? handlePixels * SonoDisplay(this->Renderer).mmPerPixel(place) : 3.0);
  }
  parts.Handle(DEEPENING).Actor->SetVisibility(parts.PresetFile.empty());
  parts.Text->SetInput(this->Renderer ? this->GetMessageLines(this->Renderer->GetSize()[0]).c_str()
                                      : this->Message.c_str());
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
