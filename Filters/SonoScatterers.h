#pragma once

#include "Echo/PointScatterers.h"

#include <memory>

class vtkPointSet;

namespace sono {

/// The points as scatterers, with the amplitudes of their point array "Amplitude"; null where there are no points.
/// Throws Error when the array is missing or has several components.
std::shared_ptr<const PointScatterers> pointScatterers(vtkPointSet* points);

} // namespace sono
