#pragma once

#include <vector>

class vtkDataObject;

namespace sono {

/// What tells one input from another. The time of a data object itself does not: ParaView makes a new shallow copy of
/// the same data for each run. Times are unique, so that equal ones of the arrays mean the same arrays.
std::vector<double> contentOf(vtkDataObject* input);

} // namespace sono
