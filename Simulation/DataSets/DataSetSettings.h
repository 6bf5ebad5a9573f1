#pragma once

#include "DataSets/DataSet.h"
#include "ImageSettings.h"

#include <string>

namespace sono {

/// The settings that a data set's parameters belong to.
struct DataSetSettings
{
  ProbeSettings probe;
  TraceSettings tracing;
  EchoSettings echo;
  BModeSettings display;

  /// The parameters of a group with their members, see Core/Parameters.h.
  template<class Self, class Visitor>
  static void visit(Self& self, SettingsGroup group, Visitor&& visitor)
  {
    switch (group)
    {
      case SettingsGroup::Probe:
        ProbeSettings::visit(self.probe, visitor);
        break;
      case SettingsGroup::Tracing:
        TraceSettings::visit(self.tracing, visitor);
        break;
      case SettingsGroup::Echo:
        EchoSettings::visit(self.echo, visitor);
        EchoSettings::visitSampling(self.echo, visitor);
        break;
      case SettingsGroup::Display:
        BModeSettings::visit(self.display, visitor);
        break;
    }
  }

  /// A parameter of that name; throws std::logic_error where there is none.
  void set(SettingsGroup group, const std::string& name, double value);

  /// Of all stages, matched to each other. Throws Error where they contradict each other.
  ImageSettings image(double pixelMm, Device device) const;
};

/// Whether a file may say it: not the seeds, which come from the data set's, nor what makes a picture depend on the
/// machine or its load (device, timeBudgetS).
bool isDrawable(const Parameter& parameter);

/// What a file that draws nothing has: the chest's defaults, the data set's probe.
DataSetSettings baseSettings(const DataSet& set);

} // namespace sono
