#include "vtkSonoProbeWidget.h"

#include "vtkSonoProbeRepresentation.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkObjectFactory.h"
#include "vtkRenderWindow.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkRenderer.h"
#include "vtkWidgetCallbackMapper.h"
#include "vtkWidgetEvent.h"

#include <string>

vtkStandardNewMacro(vtkSonoProbeWidget);

namespace {

constexpr double stepMm = 1.0;
constexpr double stepDeg = 2.0;
constexpr double stepDepthMm = 5.0;

bool isArrow(const std::string& key)
{
  return key == "Left" || key == "Right" || key == "Up" || key == "Down";
}

void nudge(vtkSonoProbeRepresentation* probe, const std::string& arrow, bool shift, bool control)
{
  const bool across = arrow == "Left" || arrow == "Right";
  const double sign = arrow == "Right" || arrow == "Up" ? 1.0 : -1.0;
  if (shift)
  {
    across ? probe->Rock(sign * stepDeg) : probe->Tilt(sign * stepDeg);
  }
  else if (control)
  {
    // Up: less deep, as the picture's far border moves.
    across ? probe->Rotate(sign * stepDeg) : probe->ChangeDepth(-sign * stepDepthMm);
  }
  else
  {
    probe->Walk(across ? sign * stepMm : 0.0, across ? 0.0 : sign * stepMm);
  }
}

} // namespace

vtkSonoProbeWidget::vtkSonoProbeWidget()
{
  this->CallbackMapper->SetCallbackMethod(vtkCommand::LeftButtonPressEvent, vtkWidgetEvent::Select, this,
                                          vtkSonoProbeWidget::Press);
  this->CallbackMapper->SetCallbackMethod(vtkCommand::MouseMoveEvent, vtkWidgetEvent::Move, this,
                                          vtkSonoProbeWidget::Move);
  this->CallbackMapper->SetCallbackMethod(vtkCommand::LeftButtonReleaseEvent, vtkWidgetEvent::EndSelect, this,
                                          vtkSonoProbeWidget::Release);
  this->CallbackMapper->SetCallbackMethod(vtkCommand::KeyPressEvent, vtkWidgetEvent::Translate, this,
                                          vtkSonoProbeWidget::Nudge);
}

vtkSonoProbeWidget::~vtkSonoProbeWidget() = default;

void vtkSonoProbeWidget::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Moving: " << this->Moving << endl;
}

void vtkSonoProbeWidget::SetRepresentation(vtkSonoProbeRepresentation* representation)
{
  this->Superclass::SetWidgetRepresentation(representation);
}

vtkSonoProbeRepresentation* vtkSonoProbeWidget::GetProbeRepresentation()
{
  return vtkSonoProbeRepresentation::SafeDownCast(this->WidgetRep);
}

void vtkSonoProbeWidget::CreateDefaultRepresentation()
{
  if (!this->WidgetRep)
  {
    this->WidgetRep = vtkSonoProbeRepresentation::New();
  }
}

void vtkSonoProbeWidget::SetEnabled(int enabling)
{
  if (!enabling && this->Moving)
  {
    this->Moving = false;
    this->ReleaseFocus();
  }
  this->Superclass::SetEnabled(enabling);
}

void vtkSonoProbeWidget::SetCursor(int state)
{
  this->RequestCursorShape(state == vtkSonoProbeRepresentation::OUTSIDE ? VTK_CURSOR_DEFAULT : VTK_CURSOR_HAND);
}

void vtkSonoProbeWidget::Press(vtkAbstractWidget* widget)
{
  auto* self = static_cast<vtkSonoProbeWidget*>(widget);
  vtkSonoProbeRepresentation* probe = self->GetProbeRepresentation();
  const int* at = self->Interactor->GetEventPosition();
  if (!self->CurrentRenderer || !self->CurrentRenderer->IsInViewport(at[0], at[1]) ||
      probe->ComputeInteractionState(at[0], at[1]) == vtkSonoProbeRepresentation::OUTSIDE)
  {
    return;
  }
  self->Moving = true;
  self->GrabFocus(self->EventCallbackCommand);
  self->EventCallbackCommand->SetAbortFlag(1);
  self->StartInteraction();
  self->InvokeEvent(vtkCommand::StartInteractionEvent, nullptr);
  double start[2] = { static_cast<double>(at[0]), static_cast<double>(at[1]) };
  probe->StartWidgetInteraction(start);
  self->Render();
}

void vtkSonoProbeWidget::Move(vtkAbstractWidget* widget)
{
  auto* self = static_cast<vtkSonoProbeWidget*>(widget);
  vtkSonoProbeRepresentation* probe = self->GetProbeRepresentation();
  const int* at = self->Interactor->GetEventPosition();
  if (!self->Moving)
  {
    const std::string before = probe->GetMessage();
    const int state = probe->ComputeInteractionState(at[0], at[1]);
    self->SetCursor(state);
    probe->Highlight(1);
    if (before != probe->GetMessage())
    {
      self->Render();
    }
    return;
  }
  double here[2] = { static_cast<double>(at[0]), static_cast<double>(at[1]) };
  probe->WidgetInteraction(here);
  self->EventCallbackCommand->SetAbortFlag(1);
  self->InvokeEvent(vtkCommand::InteractionEvent, nullptr);
  self->Render();
}

void vtkSonoProbeWidget::Release(vtkAbstractWidget* widget)
{
  auto* self = static_cast<vtkSonoProbeWidget*>(widget);
  if (!self->Moving)
  {
    return;
  }
  self->Moving = false;
  self->ReleaseFocus();
  double here[2] = { 0.0, 0.0 };
  self->GetProbeRepresentation()->EndWidgetInteraction(here);
  self->EventCallbackCommand->SetAbortFlag(1);
  self->EndInteraction();
  self->InvokeEvent(vtkCommand::EndInteractionEvent, nullptr);
  self->Render();
}

void vtkSonoProbeWidget::Nudge(vtkAbstractWidget* widget)
{
  auto* self = static_cast<vtkSonoProbeWidget*>(widget);
  vtkSonoProbeRepresentation* probe = self->GetProbeRepresentation();
  const char* key = self->Interactor->GetKeySym();
  if (self->Moving || !key || !isArrow(key))
  {
    return;
  }
  self->InvokeEvent(vtkCommand::StartInteractionEvent, nullptr);
  nudge(probe, key, self->Interactor->GetShiftKey() != 0, self->Interactor->GetControlKey() != 0);
  self->EventCallbackCommand->SetAbortFlag(1);
  self->InvokeEvent(vtkCommand::InteractionEvent, nullptr);
  self->InvokeEvent(vtkCommand::EndInteractionEvent, nullptr);
  self->Render();
}
