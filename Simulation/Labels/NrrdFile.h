#pragma once

#include <teem/nrrd.h>

#include <memory>
#include <string>

namespace sono {

struct NukeNrrd
{
  void operator()(Nrrd* nrrd) const { nrrdNuke(nrrd); }
};
using NrrdPointer = std::unique_ptr<Nrrd, NukeNrrd>;

/// Throws Error naming the file and teem's reason. From any thread.
NrrdPointer loadNrrd(const std::string& path);

} // namespace sono
