#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

class vtkSMSessionProxyManager;
class vtkSMSourceProxy;

/// What is shown by one click, of the sources that come with SonoVDB alone.
struct SonoExample
{
  using Settings = std::vector<std::pair<const char*, double>>; ///< properties and their values

  const char* name;
  const char* tip;
  const char* source; ///< XML name of the label map's source
  Settings ofSource;
  const char* preset; ///< of the probe, by its bundled name
  Settings ofUltrasound;
  std::array<double, 9> pose; ///< position in mm, axial, lateral
  bool hasNeedle = false;
  std::array<double, 6> needleMm{}; ///< hub and tip
  bool depthIsDown = false;         ///< in the world: phantoms' z is depth
};

const std::vector<SonoExample>& sonoExamples();

/// Makes the sources and the Simulate Ultrasound of an example, which is returned; shows nothing.
vtkSMSourceProxy* sonoMakeExample(const SonoExample& example, vtkSMSessionProxyManager* manager);
