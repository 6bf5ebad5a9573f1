#pragma once

#include "Files/Hdf5File.h"
#include "Probe/ArrayElements.h"

#include <vector>

namespace sono {

// What zea's files of lines and of channels have in common (zea's FileSpec of 0.1). Lengths in m, times in s.

/// Coordinates one after the other, times a factor.
std::vector<float> zeaCoordinates(const std::vector<Vec3d>& vectors, double factor);
void writeZeaHeader(Hdf5File& file);
void writeZeaProbe(const ProbeSettings& probe, const ArrayElements& elements, Hdf5File& file);
void writeZeaPose(const ProbePose& pose, Hdf5File& file);
/// When frames were made, from the first one on, as arrays `timestamps` and `start_time_offset` of a group; nothing of
/// one frame.
void writeZeaTimes(const std::vector<double>& timesS, const std::string& group, Hdf5File& file);

} // namespace sono
