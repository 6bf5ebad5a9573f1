#include "SonoFirstPose.h"

#include "SonoWindows.h"

#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"

namespace {

const char* const parts[] = { "PositionMm", "Axial", "Lateral" };

/// Where the best window is; nothing where there is none, of which the search has said why.
void place(vtkSMSourceProxy* ultrasound)
{
  const SonoWindows found = sonoFindWindows(ultrasound, SonoWindowsOf::Input, "");
  if (found.windows.empty())
  {
    return;
  }
  const SonoWindow& best = found.windows.front();
  if (!best.preset.empty())
  {
    for (const auto& [name, value] : sonoPresetNumbers(ultrasound->GetSessionProxyManager(), best.preset))
    {
      vtkSMPropertyHelper(ultrasound, name.c_str()).Set(value);
    }
  }
  if (best.depthMm > 0.0)
  {
    vtkSMPropertyHelper(ultrasound, "DepthMm").Set(best.depthMm);
  }
  for (std::size_t part = 0; part < 3; ++part)
  {
    vtkSMPropertyHelper(ultrasound, parts[part]).Set(&best.pose[3 * part], 3);
  }
  ultrasound->UpdateVTKObjects();
}

/// Of Fill Body.
class PlaceAgain : public vtkCommand
{
public:
  static PlaceAgain* New() { return new PlaceAgain; }
  void Execute(vtkObject*, unsigned long, void*) override
  {
    if (!this->Ultrasound->GetSessionProxyManager()->GetInLoadXMLState() && sonoPoseOf(this->Ultrasound) == this->Found)
    {
      place(this->Ultrasound);
      this->Found = sonoPoseOf(this->Ultrasound);
    }
  }

  vtkSMSourceProxy* Ultrasound = nullptr; // which owns the property that is observed
  std::array<double, 9> Found{};
};

} // namespace

void sonoSetFirstPose(vtkSMSourceProxy* ultrasound)
{
  for (const char* part : parts)
  {
    if (!ultrasound->GetProperty(part)->IsValueDefault())
    {
      return;
    }
  }
  if (!vtkSMPropertyHelper(ultrasound, "Input").GetAsProxy())
  {
    return;
  }
  place(ultrasound);
  vtkNew<PlaceAgain> again;
  again->Ultrasound = ultrasound;
  again->Found = sonoPoseOf(ultrasound);
  ultrasound->GetProperty("FillBody")->AddObserver(vtkCommand::ModifiedEvent, again);
}
