#pragma once

#include <vector>

class pqPipelineSource;
class pqView;
class vtkSMProxy;

/// Each Simulate Ultrasound there is, in the order in which they were made.
std::vector<pqPipelineSource*> sonoUltrasounds();

/// Two of a probe's pictures, side by side.
struct SonoSplit
{
  pqPipelineSource* second = nullptr;
  pqView* body = nullptr; ///< in which the probe stands
};

/// Makes a second Simulate Ultrasound of the same input, with the settings of the first, and shows the flat images of
/// both side by side. Both share a probe; all else is each one's own.
SonoSplit sonoSplitScreen(pqPipelineSource* first);

/// The property whose number, when it is not 0, those of an input have in common who share a probe; see
/// vtkSonoUltrasound::SetSharedProbe.
constexpr const char* sonoSharedProbe = "SharedProbe";
/// What they have alike while there is a pqSonoKeptAlike: where the probe stands, how deep it looks and whether it is
/// being moved.
constexpr const char* sonoProbeProperties[] = { "PositionMm", "Axial",   "Lateral",
                                                "DepthMm",    "Preview", "PrepareInteraction" };
/// Each group of two or more who share a probe, in the order in which they were made.
std::vector<std::vector<vtkSMProxy*>> sonoProbeSharers();

/// The two of a matrix probe's planes, each one's own Simulate Ultrasound of the same input.
struct SonoPlanes
{
  pqPipelineSource* first = nullptr; ///< none: there is no such pair
  pqPipelineSource* second = nullptr;
};

/// Their property that names the plane; see vtkSonoProbeSource::SetMatrixPlane.
constexpr const char* sonoMatrixPlane = "MatrixPlane";
/// The pair that this one is of, also of a state's.
SonoPlanes sonoPlanesOf(const pqPipelineSource* source);
/// All such pairs: each its first plane and its second.
std::vector<std::vector<vtkSMProxy*>> sonoPlanePairs();
/// As sonoSplitScreen, but the first one scans the first plane from now on, and the second one, which has all other
/// settings in common with it while there is a pqSonoKeptAlike, the second plane. The body shows both.
SonoSplit sonoShowBiplane(pqPipelineSource* first);
/// The second one goes, with what was made of it and the layout that shows both; the first one scans the volume again.
void sonoEndBiplane(const SonoPlanes& planes);
