#pragma once

#include "Core/KeyText.h"
#include "Core/Parameters.h"
#include "SonoParameters.h"

#include <stdexcept>
#include <string>
#include <type_traits>

namespace sono {

/// The parameters of one settings struct of Simulation.
template<class Settings>
class SettingsOf : public ParameterSet
{
public:
  Settings settings;

  bool set(const char* name, double number) override
  {
    bool isChanged = false;
    find(settings, name, [&](auto& value) {
      using Value = std::decay_t<decltype(value)>;
      const Value wanted = valueOf<Value>(number);
      isChanged = value != wanted;
      value = wanted;
    });
    return isChanged;
  }

  double get(const char* name) const override
  {
    double number = 0.0;
    find(settings, name, [&](const auto& value) { number = numberOf(value); });
    return number;
  }

  void print(ostream& os, vtkIndent indent) const override
  {
    Settings::visit(settings, [&](const auto& value, const Parameter& parameter) {
      os << indent << propertyName(parameter) << ": " << numberOf(value) << endl;
    });
  }

private:
  template<class Self, class Use>
  static void find(Self& self, const char* name, const Use& use)
  {
    bool isFound = false;
    Settings::visit(self, [&](auto& value, const Parameter& parameter) {
      if (propertyName(parameter) == name)
      {
        isFound = true;
        use(value);
      }
    });
    if (!isFound)
    {
      throw std::logic_error(std::string("no parameter is called ") + name);
    }
  }
};

/// All parameters of some settings, to the last bit.
template<class Settings>
void addParameters(const Settings& settings, KeyText& key)
{
  Settings::visit(settings, [&](const auto& value, const Parameter&) { key.add(numberOf(value)); });
}

/// The settings that a stage made itself as SettingsOf<Settings>.
template<class Settings>
const Settings& settingsIn(const ParameterSet& parameters)
{
  return static_cast<const SettingsOf<Settings>&>(parameters).settings;
}
template<class Settings>
Settings& settingsIn(ParameterSet& parameters)
{
  return static_cast<SettingsOf<Settings>&>(parameters).settings;
}

} // namespace sono
