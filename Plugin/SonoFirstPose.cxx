#include "SonoFirstPose.h"

#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSmartPointer.h"

#include <utility>

void sonoSetFirstPose(vtkSMSourceProxy* ultrasound)
{
  constexpr std::pair<const char*, const char*> parts[] = { { "PositionMm", "ProbePositionMm" },
                                                            { "Axial", "ProbeAxial" },
                                                            { "Lateral", "ProbeLateral" } };
  for (const auto& [property, array] : parts)
  {
    if (!ultrasound->GetProperty(property)->IsValueDefault())
    {
      return;
    }
  }
  const vtkSMPropertyHelper input(ultrasound, "Input");
  if (!input.GetAsProxy())
  {
    return;
  }
  auto window = vtkSmartPointer<vtkSMSourceProxy>::Take(
    vtkSMSourceProxy::SafeDownCast(ultrasound->GetSessionProxyManager()->NewProxy("filters", "SonoAcousticWindow")));
  vtkSMPropertyHelper(window, "Input").Set(input.GetAsProxy(), input.GetOutputPort());
  vtkSMPropertyHelper(window, "FillBody").Set(vtkSMPropertyHelper(ultrasound, "FillBody").GetAsInt());
  window->UpdateVTKObjects();
  window->UpdatePipeline();
  vtkPVDataSetAttributesInformation* field =
    window->GetDataInformation()->GetAttributeInformation(vtkDataObject::FIELD);
  for (const auto& [property, array] : parts)
  {
    if (vtkPVArrayInformation* values = field->GetArrayInformation(array))
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        vtkSMPropertyHelper(ultrasound, property).Set(axis, values->GetComponentRange(axis)[0]);
      }
    }
  }
  ultrasound->UpdateVTKObjects();
}
