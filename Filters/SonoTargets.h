#pragma once

#include "Labels/TissueTable.h"
#include "Trace/Targets.h"

#include <string>
#include <vector>

class vtkPolyData;

namespace sono {

/// The surfaces of `polyData` as targets, one for each tissue in them: the cell array of strings "Tissue" names it for
/// each polygon, else the field array "Tissue" for all, else `tissueName`. Polygons are cut into triangles and points
/// at the same place become one. The field array "RodDiameterMm" says that they are of a solid round rod. No poly data,
/// or one without cells, gives no targets. Throws Error for a tissue that the table does not hold.
std::vector<TargetSurface> targetSurfaces(vtkPolyData* polyData, const std::string& tissueName,
                                          const TissueTable& tissues);

} // namespace sono
