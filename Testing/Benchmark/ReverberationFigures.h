#pragma once

#include "ImageSettings.h"
#include "LayerStack.h"
#include "Scene/Scene.h"

#include <string>
#include <vector>

// Range as time, and what is reflected several times, against what they must be (Data/docs/physics.md section 13).
// Details of each go to the standard error.

namespace sono {

/// The largest errors of what an image's line shows of a stack of layers.
struct StackErrors
{
  double rangeMm = 0.0;
  double amplitudeDb = 0.0;
};

/// A line without an aperture across smooth plane layers without scatterers: where its arrivals lie and how strong they
/// are against the exact ones (LayerStack.h), of which all above -60 dB count. The pulse is 2.5 MHz, and sinks. Layers
/// are as many voxels thick.
StackErrors stackErrors(const std::string& name, const test::LayerStack& stack, double fractionalBandwidth,
                        int pathsPerLine, double voxelMm);

/// A lung 30 mm under soft tissue, which rings between it and a face that reflects half the pressure.
struct AlineErrors
{
  double spacingMm = 0.0;   ///< of the first three
  double amplitudeDb = 0.0; ///< of each against r^n rt^(n-1) and what tissue absorbs
  double apertureDb = 0.0;  ///< the same with the P4-2's beam, against that of a lung n times as deep
};
AlineErrors alineErrors(int pathsPerLine);

/// Speckle over that lung, and its copies: straight back after lung and face, mirrored by the lung, and by its own way
/// after lung and face. The largest error of their levels against its own, dB.
double tissueReverberationErrorDb(int pathsPerLine);

/// What a diaphragm is made of: of labels the paths know the normal to a degree, of triangles exactly.
enum class Diaphragm
{
  Labels,
  Mesh
};

/// A sphere of bright tissue in front of a slanted diaphragm, behind which is lung: how far the middle of what is seen
/// behind lies from where a mirror would show it, by the time that sound takes, mm.
double mirrorImageErrorMm(int pathsPerLine, Diaphragm diaphragm);

/// What of an image comes from several reflections at boundaries, by depth and number of paths.
struct ReverberationDrift
{
  double fromMm;
  double toMm;
  double pictureDb;            ///< level of all that the lines show there
  std::vector<double> levelDb; ///< of the mean power, parallel to the numbers of paths; a perfect mirror's is 0
  double driftDb;              ///< largest less least
};
std::vector<ReverberationDrift> reverberationDrifts(const Scene& scene, const std::vector<ScanLine>& lines,
                                                    TraceSettings tracing, const EchoSettings& echo,
                                                    const std::vector<int>& pathsPerLine);

} // namespace sono
