#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

class vtkSMProxy;
class vtkSMSessionProxyManager;
class vtkSMSourceProxy;

/// A place for a probe, as an Acoustic Window or Standard Views find it.
struct SonoWindow
{
  std::string sentence;         ///< what is seen from there
  std::string preset;           ///< the probe for it, by its bundled preset's name; empty: any
  double depthMm = 0.0;         ///< 0: not known
  std::array<double, 9> pose{}; ///< position, axial, lateral
};

/// The pose that the properties of a source with a probe, or of a probe's widget, say: position, axial, lateral.
std::array<double, 9> sonoPoseOf(vtkSMProxy* proxy);

struct SonoWindows
{
  std::vector<SonoWindow> windows;  ///< best first
  std::vector<std::string> targets; ///< names that a target may have
  std::vector<std::string> refused; ///< views that are not obtainable, a sentence each
  std::string refusal;              ///< why there are no windows, one sentence
};

/// Looks for windows in the label map that is connected to a Simulate Ultrasound (its input), or in the anatomy that it
/// makes of it. An empty target: the pose that the data bring along, the heart, or another organ. On the client; the
/// search runs where the data are.
enum class SonoWindowsOf
{
  Input,
  Anatomy
};
SonoWindows sonoFindWindows(vtkSMSourceProxy* ultrasound, SonoWindowsOf what, const std::string& target);

/// Looks for standard views in that anatomy; each sentence begins with the view's name.
SonoWindows sonoFindViews(vtkSMSourceProxy* ultrasound);

/// The settings that a bundled preset gives, by the names of properties; none where there is no such preset.
std::vector<std::pair<std::string, double>> sonoPresetNumbers(vtkSMSessionProxyManager* manager,
                                                              const std::string& preset);
