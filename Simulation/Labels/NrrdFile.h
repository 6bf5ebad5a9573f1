#pragma once

#include "Labels/ByteStream.h"

#include <teem/nrrd.h>

#include <memory>
#include <string>

namespace sono {

struct NukeNrrd
{
  void operator()(Nrrd* nrrd) const { nrrdNuke(nrrd); }
};
using NrrdPointer = std::unique_ptr<Nrrd, NukeNrrd>;

/// An NRRD file without its data: they follow in the stream as they stand in the file.
struct NrrdFile
{
  NrrdPointer header;
  bool swapped = false; ///< the bytes of a number lie the other way round than in this machine
  ByteStream data;
};

/// Both throw Error naming the file and teem's reason, also when the header promises more than the file can hold,
/// before memory is taken for it. From any thread. Data: attached or in one file beside, raw, gzip, text or
/// hexadecimal.
NrrdFile openNrrdFile(const std::string& path);
NrrdPointer loadNrrd(const std::string& path);

} // namespace sono
