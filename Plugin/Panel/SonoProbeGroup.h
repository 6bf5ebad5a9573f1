#pragma once

#include "vtkSMProperty.h"
#include "vtkSMPropertyGroup.h"
#include "vtkSMPropertyIterator.h"
#include "vtkSMProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSmartPointer.h"

/// The group and, so that the widget follows them, the properties that lay out the scan lines.
inline vtkSmartPointer<vtkSMPropertyGroup> sonoLayout(vtkSMProxy* proxy, vtkSMPropertyGroup* group)
{
  auto all = vtkSmartPointer<vtkSMPropertyGroup>::New();
  for (unsigned int i = 0; i < group->GetNumberOfProperties(); ++i)
  {
    vtkSMProperty* property = group->GetProperty(i);
    all->AddProperty(group->GetFunction(property), property, group->GetPropertyName(i));
  }
  vtkSMProxy* drawn =
    proxy->GetSessionProxyManager()->GetPrototypeProxy("representations", "SonoProbeWidgetRepresentation");
  const auto names = vtkSmartPointer<vtkSMPropertyIterator>::Take(drawn->NewPropertyIterator());
  for (names->Begin(); !names->IsAtEnd(); names->Next())
  {
    const char* name = names->GetKey();
    vtkSMProperty* property = proxy->GetProperty(name);
    if (property && !all->GetProperty(name))
    {
      all->AddProperty(name, property, name);
    }
  }
  return all;
}
