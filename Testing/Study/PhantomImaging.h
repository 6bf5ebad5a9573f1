#pragma once

#include "Echo/FormRf.h"
#include "Image/BMode.h"
#include "Image/ScanConvert.h"
#include "Phantoms/CalibrationPhantom.h"
#include "Probe/ArrayAperture.h"
#include "Scene/Scene.h"
#include "Trace/Trace.h"

#include <memory>
#include <vector>

namespace sono::study {

/// How a wire echoes.
enum class WireModel
{
  Scatterers, ///< a line of scatterers, as strong as the exact series for a fluid cylinder has it
  Surface,    ///< a target, as a needle is one: an Embree surface that paths meet and whose pieces echo
  Voxels      ///< voxels of the label map, as the seed has it: boundary and scatterers
};

/// The settings of the phantom study. What the seed (Amadou 2024, tables 3 and 4 and the text around them) gives is
/// taken from there; every other number is chosen once, for all lesions and wires, with the reason beside it.
struct PhantomImaging
{
  ScanGeometry geometry;
  TraceSettings tracing;
  EchoSettings echo;
  BModeSettings bmode;
  double pixelMm = 0.23; ///< the seed's
};

/// `lines` scan lines; the seed does not tell how it weights the elements. The pulse-echo field is computed here, which
/// takes a second.
PhantomImaging phantomImaging(int lines = 256, Apodization apodization = Apodization::Boxcar);

/// That probe's elements.
ArrayAperture phantomAperture(Apodization apodization = Apodization::Boxcar);

/// Rms echo of the phantom's gel at a depth, before any gain, dB to a perfect reflector at the focus.
double gelDbAt(const PhantomImaging& imaging, double depthMm);

/// The phantom, ready to be imaged.
class PhantomBench
{
public:
  /// The bundled targets, or others; `spacingMm` is the edge of a voxel.
  PhantomBench(WireModel wires, double spacingMm);
  PhantomBench(std::vector<PhantomTarget> targets, WireModel wires, double spacingMm);

  const std::vector<PhantomTarget>& targets() const { return targets_; }
  const CalibrationPhantomSettings& settings() const { return settings_; }
  const Scene& scene() const { return *scene_; }

  /// The RF of a view, with a pattern of scatterers of its own for each seed.
  RfLines image(const PhantomImaging& imaging, int view, unsigned seed) const;

private:
  double wireMm() const; ///< diameter of the wires, which are all alike

  WireModel wires_;
  CalibrationPhantomSettings settings_;
  std::vector<PhantomTarget> targets_;
  std::vector<TargetSurface> surfaces_;
  std::unique_ptr<Scene> scene_;
};

/// The repository's tissues, with the labels of `volume` assigned. Throws Error when one has none.
std::unique_ptr<Scene> sceneOf(LabelVolume volume, const std::string& outside = "air");
TissueTable bundledTissues();

/// An image's value at a place of the probe's plane, bilinear; NaN beyond its pixels.
double valueAt(const PlaneImage& image, double lateralMm, double depthMm);

/// The values of a disc around a place of the probe's plane.
std::vector<float> valuesIn(const PlaneImage& image, double lateralMm, double depthMm, double radiusMm);

/// The envelope in dB (20 log10), scan-converted.
PlaneImage decibelImage(const PhantomImaging& imaging, const RfLines& rf);

} // namespace sono::study
