#pragma once

#include <string>
#include <vector>

namespace sono {

/// Reads a grey map: a CSV file with the columns level (ascending, from 0, the bottom of the range, to 1, white) and
/// grey (0 black to 1 white), straight in between. Returns the greys of 1025 equal steps of level. Throws Error naming
/// file and line.
std::vector<float> readGreyMap(const std::string& path);

} // namespace sono
