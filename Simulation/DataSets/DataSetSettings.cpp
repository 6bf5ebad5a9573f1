#include "DataSets/DataSetSettings.h"

#include "ChestDefaults.h"

#include <array>
#include <stdexcept>
#include <string_view>
#include <type_traits>

namespace sono {

void DataSetSettings::set(SettingsGroup group, const std::string& name, double number)
{
  bool isFound = false;
  visit(*this, group, [&](auto& value, const Parameter& parameter) {
    if (name == parameter.name)
    {
      value = valueOf<std::decay_t<decltype(value)>>(number);
      isFound = true;
    }
  });
  if (!isFound)
  {
    throw std::logic_error("no parameter is called " + name);
  }
}

ImageSettings DataSetSettings::image(double pixelMm, Device device) const
{
  ImageSettings settings{ probe.geometry, tracing, echo, display, pixelMm };
  settings.echo.centreFrequencyMHz = probe.receivedMHz();
  settings.echo.fractionalBandwidth = probe.receivedBandwidth();
  settings.echo.imagingMode = probe.imagingMode;
  settings.echo.aperture = probe.aperture();
  settings.tracing.facePressureKPa = probe.facePressureKPa;
  settings.geometry.validate();
  settings.matchStages();
  settings.setDevice(device);
  settings.tracing.validate();
  settings.echo.validate();
  settings.bmode.validate();
  return settings;
}

bool isDrawable(const Parameter& parameter)
{
  const std::array<std::string_view, 5> others{ "device", "timeBudgetS", "pathSeed", "scattererSeed", "noiseSeed" };
  for (const std::string_view name : others)
  {
    if (name == parameter.name)
    {
      return false;
    }
  }
  return true;
}

DataSetSettings baseSettings(const DataSet& set)
{
  DataSetSettings settings;
  settings.probe = set.probe;
  setChestDefaults(settings.tracing);
  setChestDefaults(settings.display);
  return settings;
}

} // namespace sono
