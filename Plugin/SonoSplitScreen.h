#pragma once

class pqPipelineSource;
class pqView;

/// Two of a probe's pictures, side by side.
struct SonoSplit
{
  pqPipelineSource* second = nullptr;
  pqView* body = nullptr; ///< in which the probe stands
};

/// Makes a second Simulate Ultrasound of the same input, with the settings of the first, and shows the flat images of
/// both side by side. Where the probe stands, how deep it looks and whether it is being moved are linked, in Tools >
/// Manage Links; all else is each one's own.
SonoSplit sonoSplitScreen(pqPipelineSource* first);

/// The two of a matrix probe's planes, each one's own Simulate Ultrasound of the same input.
struct SonoPlanes
{
  pqPipelineSource* first = nullptr; ///< none: there is no such pair
  pqPipelineSource* second = nullptr;
};

/// Their property that names the plane; see vtkSonoProbeSource::SetMatrixPlane.
constexpr const char* sonoMatrixPlane = "MatrixPlane";
/// Whether it is a Simulate Ultrasound.
bool sonoHasPlanes(const pqPipelineSource* source);
/// The pair that this one is of, also of a state's.
SonoPlanes sonoPlanesOf(const pqPipelineSource* source);
/// As sonoSplitScreen, but the first one scans the first plane from now on, and the second one, which has all other
/// settings in common with it while there is a pqSonoBiplane, the second plane. The body shows both.
SonoSplit sonoShowBiplane(pqPipelineSource* first);
/// The second one goes, with what was made of it and the layout that shows both; the first one scans the volume again.
void sonoEndBiplane(const SonoPlanes& planes);
