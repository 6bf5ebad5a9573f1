#pragma once

#include "Cuda/ImageJob.h"

#include <complex>
#include <string>
#include <vector>

namespace sono {

/// A job for the device with what the CPU made of it, so that a machine with a GPU needs none of the libraries that a
/// scene is made with. Written and read by the same build: structures are stored as they lie in memory.
struct JobFile
{
  ImageJob job;
  std::vector<std::complex<float>> cpuIq; ///< of the first image; may be empty
  double scatterers = 0.0;                ///< visits of a scatterer by a beam, all lines; 0: not counted
};

void writeJob(const JobFile& file, const std::string& path);
/// Throws Error naming the file when it is not a job of this build.
JobFile readJob(const std::string& path);

} // namespace sono
