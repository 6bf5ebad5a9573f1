#pragma once

#include "Scene/Scene.h"
#include "Trace/RecordPaths.h"
#include "Trace/Targets.h"

#include <string>
#include <vector>

class vtkPolyData;

namespace sono {

/// The tissues by the numbers that recorded paths give them.
std::vector<std::string> mediaNames(const Scene& scene, const std::vector<TargetSurface>& targets);

/// One polyline a path, with the point arrays "Intensity", "IntensityDb" (20 log10, at least -400) and "Bounce", and
/// the cell array "Line".
void fillPaths(const std::vector<RecordedPath>& paths, vtkPolyData* polyData);

/// One vertex a boundary that a path met, with the point arrays "Intensity", "IntensityDb", "Bounce", "EchoAmplitude",
/// "IncidenceDeg", "DepthMm", "PathMm", "Line", "FromTissue" and "ToTissue" (names of the media, see BoundaryHit) and,
/// as the normals, "Normals".
void fillHits(const std::vector<RecordedPath>& paths, const std::vector<std::string>& media, vtkPolyData* polyData);

} // namespace sono
