#include "SonoWindows.h"

#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSmartPointer.h"
#include "vtkSonoUltrasound.h"

#include <cstdlib>
#include <sstream>

namespace {

std::vector<std::string> stringsOf(vtkSMProxy* proxy, const char* property)
{
  const vtkSMPropertyHelper helper(proxy, property);
  std::vector<std::string> strings;
  for (unsigned int i = 0; i < helper.GetNumberOfElements(); ++i)
  {
    strings.emplace_back(helper.GetAsString(i));
  }
  return strings;
}

std::vector<std::string> fieldsOf(const std::string& row)
{
  std::vector<std::string> fields;
  std::istringstream stream(row);
  for (std::string field; std::getline(stream, field, '\t');)
  {
    fields.push_back(field);
  }
  return fields;
}

vtkSmartPointer<vtkSMSourceProxy> makeProxy(vtkSMSessionProxyManager* manager, const char* group, const char* name)
{
  return vtkSmartPointer<vtkSMSourceProxy>::Take(vtkSMSourceProxy::SafeDownCast(manager->NewProxy(group, name)));
}

/// A search in the label map that is connected to a Simulate Ultrasound, or in the anatomy that it makes of it.
vtkSmartPointer<vtkSMSourceProxy> makeSearch(vtkSMSourceProxy* ultrasound, SonoWindowsOf what, const char* name)
{
  auto search = makeProxy(ultrasound->GetSessionProxyManager(), "filters", name);
  const vtkSMPropertyHelper input(ultrasound, "Input");
  if (what == SonoWindowsOf::Anatomy)
  {
    vtkSMPropertyHelper(search, "Input").Set(ultrasound, vtkSonoUltrasound::ANATOMY);
  }
  else
  {
    vtkSMPropertyHelper(search, "Input").Set(input.GetAsProxy(), input.GetOutputPort());
  }
  vtkSMPropertyHelper(search, "FillBody").Set(vtkSMPropertyHelper(ultrasound, "FillBody").GetAsInt());
  return search;
}

/// Runs it, and takes the places and the refusal.
SonoWindows findBy(vtkSMSourceProxy* search)
{
  search->UpdateVTKObjects();
  search->UpdatePipeline();
  search->UpdatePropertyInformation();

  SonoWindows found;
  const std::vector<std::string> refusal = stringsOf(search, "Refusal");
  found.refusal = refusal.empty() ? "" : refusal[0];
  constexpr std::size_t columns = 12;
  for (const std::string& row : stringsOf(search, "Rows"))
  {
    const std::vector<std::string> fields = fieldsOf(row);
    if (fields.size() == columns)
    {
      SonoWindow window{ fields[0], fields[1], std::atof(fields[2].c_str()), {} };
      for (std::size_t i = 0; i < window.pose.size(); ++i)
      {
        window.pose[i] = std::atof(fields[3 + i].c_str());
      }
      found.windows.push_back(window);
    }
  }
  return found;
}

} // namespace

std::array<double, 9> sonoPoseOf(vtkSMProxy* proxy)
{
  std::array<double, 9> pose{};
  double* part = pose.data();
  for (const char* name : { "PositionMm", "Axial", "Lateral" })
  {
    vtkSMPropertyHelper(proxy, name).Get(part, 3);
    part += 3;
  }
  return pose;
}

SonoWindows sonoFindWindows(vtkSMSourceProxy* ultrasound, SonoWindowsOf what, const std::string& target)
{
  const auto search = makeSearch(ultrasound, what, "SonoAcousticWindow");
  vtkSMPropertyHelper(search, "Target").Set(target.c_str());
  vtkSMPropertyHelper(search, "CacheFolder").Set(vtkSMPropertyHelper(ultrasound, "CacheFolder").GetAsString());
  SonoWindows found = findBy(search);
  found.targets = stringsOf(search, "Targets");
  return found;
}

SonoWindows sonoFindViews(vtkSMSourceProxy* ultrasound)
{
  const auto search = makeSearch(ultrasound, SonoWindowsOf::Anatomy, "SonoStandardViews");
  SonoWindows found = findBy(search);
  found.refused = stringsOf(search, "RefusedRows");
  return found;
}

std::vector<std::pair<std::string, double>> sonoPresetNumbers(vtkSMSessionProxyManager* manager,
                                                              const std::string& preset)
{
  const auto presets = makeProxy(manager, "sources", "SonoProbePresets");
  presets->UpdateVTKObjects();
  presets->UpdatePipeline();
  presets->UpdatePropertyInformation();
  const std::vector<std::string> rows = stringsOf(presets, "Rows");
  std::vector<std::pair<std::string, double>> numbers;
  const std::vector<std::string> columns = rows.empty() ? rows : fieldsOf(rows[0]);
  constexpr std::size_t firstSetting = 2; // after Preset and Name
  for (const std::string& row : rows)
  {
    const std::vector<std::string> fields = fieldsOf(row);
    for (std::size_t i = firstSetting; i < fields.size() && fields[0] == preset; ++i)
    {
      numbers.emplace_back(columns[i], std::atof(fields[i].c_str()));
    }
  }
  return numbers;
}
