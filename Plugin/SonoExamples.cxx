#include "SonoExamples.h"

#include "SonoMakeSource.h"
#include "SonoWindows.h"

#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"

namespace {

constexpr double neck = 5.0; // of the phantoms
// A finer thorax has so many triangles that drawing it in software keeps the window busy for more than five seconds.
constexpr double thoraxMm = 1.5;

template<class Names>
void set(vtkSMSourceProxy* proxy, const Names& settings)
{
  for (const auto& [name, value] : settings)
  {
    vtkSMPropertyHelper(proxy, std::string(name).c_str()).Set(value);
  }
}

} // namespace

const std::vector<SonoExample>& sonoExamples()
{
  static const std::vector<SonoExample> examples{
    { "Heart",
      "The bundled thorax in its apical four-chamber view",
      "SonoThoraxSource",
      { { "SpacingMm", thoraxMm } },
      "phased_p4-2",
      { { "DepthMm", 160.0 }, { "AddHaze", 1.0 } },
      { 87.8, -86.5, -44.9, -0.53, 0.65, 0.545, 0.843, 0.333, 0.423 } },
    { "Liver",
      "The bundled thorax's liver from the front and the right, below the ribs",
      "SonoThoraxSource",
      { { "SpacingMm", thoraxMm } },
      "curvilinear_c5-2",
      { { "DepthMm", 170.0 } },
      { -87.5, -86.5, -67.5, 0.5011, 0.8577, -0.1149, 0.8359, -0.5141, -0.1923 } },
    { "Thyroid",
      "A neck across: the left lobe with a nodule, trachea, carotid and jugular vein",
      "SonoPhantomSource",
      { { "Phantom", neck }, { "SpacingMm", 0.25 } },
      "linear_l14",
      { { "DepthMm", 45.0 }, { "CompoundFans", 5.0 } },
      { 20.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0 },
      false,
      {},
      true },
    { "Lung",
      "Along the bundled thorax's right chest: the pleura between two ribs and their shadows",
      "SonoThoraxSource",
      { { "SpacingMm", thoraxMm } },
      "linear_l14",
      { { "DepthMm", 60.0 } },
      { -76.2, -90.8, 15.0, 0.6428, 0.766, 0.0, 0.0, 0.0, 1.0 } },
    { "Phantom",
      "The middle view of the calibration phantom: wires and cylinders",
      "SonoPhantomSource",
      { { "Phantom", 0.0 }, { "SpacingMm", 0.5 } },
      "curvilinear_c5-2",
      { { "DepthMm", 160.0 } },
      { 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0 },
      false,
      {},
      true },
    { "Needle",
      "A needle with its comet's tail in a picture of the bundled thorax's liver; drag its ends",
      "SonoThoraxSource",
      { { "SpacingMm", thoraxMm } },
      "curvilinear_c5-2",
      { { "DepthMm", 120.0 } },
      { -87.5, -86.5, -67.5, 0.5011, 0.8577, -0.1149, 0.8359, -0.5141, -0.1923 },
      true,
      { -17.1, -99.0, -83.7, -70.6, -47.9, -71.4 } },
  };
  return examples;
}

vtkSMSourceProxy* sonoMakeExample(const SonoExample& example, vtkSMSessionProxyManager* manager)
{
  vtkSMSourceProxy* labels = sonoMakeSource(manager, "sources", example.source,
                                            [&](vtkSMSourceProxy* source) { set(source, example.ofSource); });
  labels->UpdatePipeline();
  vtkSMSourceProxy* needle = nullptr;
  if (example.hasNeedle)
  {
    needle = sonoMakeSource(manager, "sources", "SonoNeedle", [&](vtkSMSourceProxy* source) {
      vtkSMPropertyHelper(source, "HubMm").Set(example.needleMm.data(), 3);
      vtkSMPropertyHelper(source, "TipMm").Set(&example.needleMm[3], 3);
    });
    needle->UpdatePipeline();
  }
  const auto ofProbe = sonoPresetNumbers(manager, example.preset);
  const bool isCalibration = labels->GetProperty("Phantom") && vtkSMPropertyHelper(labels, "Phantom").GetAsInt() == 0;
  // With a pose of its own before it is registered: else one is looked for.
  return sonoMakeSource(manager, "filters", "SonoUltrasound", [&](vtkSMSourceProxy* ultrasound) {
    vtkSMPropertyHelper(ultrasound, "Input").Set(labels, 0);
    if (isCalibration)
    {
      vtkSMPropertyHelper(ultrasound, "Targets").Set(labels, 1);
      vtkSMPropertyHelper(ultrasound, "Scatterers").Set(labels, 2);
    }
    if (needle)
    {
      vtkSMPropertyHelper(ultrasound, "Targets").Set(needle, 0);
    }
    set(ultrasound, ofProbe);
    set(ultrasound, example.ofUltrasound);
    vtkSMPropertyHelper(ultrasound, "PositionMm").Set(&example.pose[0], 3);
    vtkSMPropertyHelper(ultrasound, "Axial").Set(&example.pose[3], 3);
    vtkSMPropertyHelper(ultrasound, "Lateral").Set(&example.pose[6], 3);
  });
}
