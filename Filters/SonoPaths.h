#pragma once

#include "Trace/Trace.h"

#include <vector>

class vtkPolyData;

namespace sono {

/// One polyline a path, with the point arrays "Intensity", "IntensityDb" (20 log10, at least -400) and "Bounce", and
/// the cell array "Line".
void fillPaths(const std::vector<RecordedPath>& paths, vtkPolyData* polyData);

} // namespace sono
