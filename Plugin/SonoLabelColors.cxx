#include "SonoLabelColors.h"

#include "vtkDataObject.h"
#include "vtkNew.h"
#include "vtkPVDataInformation.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTransferFunctionManager.h"
#include "vtkSmartPointer.h"

#include <array>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

/// Whether an output is a label map that knows its labels' names and colours.
bool isLabelMap(vtkSMSourceProxy* source, unsigned int port)
{
  vtkPVDataInformation* data = source->GetDataInformation(port);
  return data->GetDataSetType() == VTK_IMAGE_DATA && data->GetArrayInformation("Labels", vtkDataObject::POINT) &&
         data->GetArrayInformation("LabelColors", vtkDataObject::FIELD);
}

} // namespace

void sonoShowLabelColors(vtkSMSourceProxy* source, unsigned int port)
{
  if (!isLabelMap(source, port))
  {
    return;
  }
  vtkSMSessionProxyManager* manager = source->GetSessionProxyManager();
  auto labels = vtkSmartPointer<vtkSMSourceProxy>::Take(
    vtkSMSourceProxy::SafeDownCast(manager->NewProxy("filters", "SonoLabelTable")));
  vtkSMPropertyHelper(labels, "Input").Set(source, port);
  labels->UpdateVTKObjects();
  labels->UpdatePipeline();
  labels->UpdatePropertyInformation();
  const vtkSMPropertyHelper rows(labels, "LabelRows");
  std::map<int, std::array<double, 3>> colors;
  for (unsigned int i = 1; i < rows.GetNumberOfElements(); ++i) // behind the columns' names
  {
    std::istringstream row(rows.GetAsString(i));
    std::string id;
    std::string name;
    std::getline(row, id, '\t');
    std::getline(row, name, '\t');
    std::array<double, 3>& color = colors[std::stoi(id)];
    row >> color[0] >> color[1] >> color[2];
  }
  // Of one colour from half a number below to half a number above. ParaView's categories are no way: of more than 32 it
  // asks with a dialog.
  std::vector<double> points;
  for (const auto& [id, color] : colors)
  {
    constexpr double half = 0.499;
    constexpr double full = 255.0;
    for (const double at : { id - half, id + half })
    {
      points.insert(points.end(), { at, color[0] / full, color[1] / full, color[2] / full });
    }
  }
  vtkNew<vtkSMTransferFunctionManager> tables;
  vtkSMProxy* map = tables->GetColorTransferFunction("Labels", manager);
  vtkSMPropertyHelper(map, "AutomaticRescaleRangeMode").Set(-1); // never
  vtkSMPropertyHelper(map, "ColorSpace").Set(0);                 // RGB
  vtkSMPropertyHelper(map, "Discretize").Set(0);
  vtkSMPropertyHelper(map, "RGBPoints").Set(points.data(), static_cast<unsigned int>(points.size()));
  map->UpdateVTKObjects();
}
