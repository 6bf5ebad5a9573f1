// vtkSonoProbeRepresentation under the mouse pointer: what it is over, and how what it has grabbed follows.
#include "SonoDisplay.h"
#include "SonoProbeHead.h"
#include "SonoProbeParts.h"
#include "SonoProbePose.h"
#include "SonoProbeTexts.h"

#include "vtkMath.h"

#include <algorithm>
#include <cmath>

namespace {

constexpr double grabPixels = 10.0;

double distanceToSegment(const vtkVector2d& p, const vtkVector2d& a, const vtkVector2d& b)
{
  const vtkVector2d way = b - a;
  const double length2 = way.Dot(way);
  const double t = length2 > 0.0 ? std::clamp((p - a).Dot(way) / length2, 0.0, 1.0) : 0.0;
  return (p - a - way * t).Norm();
}

} // namespace

int vtkSonoProbeRepresentation::ComputeInteractionState(int x, int y, int)
{
  this->InteractionState = OUTSIDE;
  if (!this->Renderer)
  {
    return OUTSIDE;
  }
  const SonoDisplay display(this->Renderer);
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
  for (int step = 0; this->InteractionState == OUTSIDE && step < Internals::RingSteps; ++step)
  {
    const double distance =
      distanceToSegment(mouse, at(this->Parts->RingPoint(step)), at(this->Parts->RingPoint(step + 1)));
    this->InteractionState = distance <= 0.6 * grabPixels ? ROTATING : OUTSIDE;
  }
  return this->InteractionState;
}

void vtkSonoProbeRepresentation::StartWidgetInteraction(double eventPosition[2])
{
  Internals& parts = *this->Parts;
  const SonoDisplay display(this->Renderer);
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
    for (int step = 0; step < Internals::RingSteps; ++step)
    {
      const vtkVector3d p = parts.RingPoint(step);
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
  const SonoDisplay display(this->Renderer);
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
    this->Message = this->Parts->Skin->IsEmpty() ? sonoNoSkin : sonoOffSkin;
    this->Modified();
  }
}

void vtkSonoProbeRepresentation::FollowWithHandle(const double eventPosition[2])
{
  Internals& parts = *this->Parts;
  const SonoDisplay display(this->Renderer);
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
          this->Message = sonoSignedNumber("Rotate", parts.Moved, "degrees");
          break;
        case TILTING:
          this->Tilt(change);
          this->Message = sonoSignedNumber("Tilt", parts.Moved, "degrees");
          break;
        default:
          this->Rock(change);
          this->Message = sonoSignedNumber("Rock", parts.Moved, "degrees");
          break;
      }
    }
    if (std::abs(change) < 1e-3)
    {
      break;
    }
  }
}
