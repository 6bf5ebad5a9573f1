#include "Labels/NrrdFile.h"

#include "Core/Error.h"

#include <teem/biff.h>

#include <sys/stat.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <sstream>

namespace sono {

namespace {

/// teem collects its messages in one global place.
std::mutex teemMutex;

/// The innermost of teem's stacked messages, which is the cause.
std::string lastTeemMessage()
{
  const std::unique_ptr<char, void (*)(void*)> text(biffGetDone(NRRD), std::free);
  std::istringstream lines(text ? text.get() : "");
  std::string last = "unknown cause";
  for (std::string line; std::getline(lines, line);)
  {
    last = line.empty() ? last : line;
  }
  return last;
}

struct NixState
{
  void operator()(NrrdIoState* state) const { nrrdIoStateNix(state); }
};
using StatePointer = std::unique_ptr<NrrdIoState, NixState>;

struct CloseFile
{
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using FilePointer = std::unique_ptr<std::FILE, CloseFile>;

[[noreturn]] void refuse(const std::string& path, const std::string& why)
{
  throw Error("cannot read '" + path + "': it is no complete NRRD file (" + why + ").");
}

/// A header, and its data file at the first byte.
struct Header
{
  NrrdPointer nrrd{ nrrdNew() };
  StatePointer state{ nrrdIoStateNew() };
  FilePointer data;
};

Header readHeader(const std::string& path)
{
  // teem would read a picture or a table of numbers under this name, too.
  char magic[4] = {};
  std::ifstream(path, std::ios::binary).read(magic, sizeof(magic));
  if (std::memcmp(magic, "NRRD", sizeof(magic)) != 0)
  {
    refuse(path, "it does not begin with NRRD");
  }
  const std::lock_guard<std::mutex> lock(teemMutex);
  Header header;
  header.state->skipData = AIR_TRUE;
  header.state->keepNrrdDataFileOpen = AIR_TRUE;
  const bool failed = nrrdLoad(header.nrrd.get(), path.c_str(), header.state.get()) != 0;
  header.data.reset(header.state->dataFile);
  if (failed)
  {
    refuse(path, lastTeemMessage());
  }
  if (header.state->dataFNFormat || header.state->dataFNArr->len > 1 || !header.data)
  {
    throw Error("cannot read '" + path + "': its data are spread over several files; save it as one.");
  }
  return header;
}

/// What the header promises, in bytes; refuses what cannot be in the file.
std::uint64_t promisedBytes(const Header& header, const std::string& path)
{
  const Nrrd& nrrd = *header.nrrd;
  const NrrdEncoding* const encoding = header.state->encoding;
  if (nrrd.type <= nrrdTypeUnknown || nrrd.type >= nrrdTypeBlock)
  {
    refuse(path, "its values are not numbers");
  }
  constexpr std::uint64_t most = std::uint64_t(1) << 36;
  std::uint64_t count = 1;
  for (unsigned axis = 0; axis < nrrd.dim; ++axis)
  {
    count = nrrd.axis[axis].size < most ? count * nrrd.axis[axis].size : most;
    if (count >= most)
    {
      refuse(path, "its header claims more values than any image has");
    }
  }
  struct stat status
  {
  };
  const long start = std::ftell(header.data.get());
  const bool isFile = fstat(fileno(header.data.get()), &status) == 0 && S_ISREG(status.st_mode);
  const std::uint64_t stored = isFile && start >= 0 && start <= status.st_size ? status.st_size - start : 0;
  // A text's numbers have a digit and, but for the last, something between; a byte has two hexadecimal digits.
  const std::uint64_t bytes = count * nrrdTypeSize[nrrd.type];
  const bool isText = encoding == nrrdEncodingAscii;
  if ((isText && 2 * count > stored + 1) || (encoding == nrrdEncodingHex && 2 * bytes > stored) ||
      (encoding == nrrdEncodingRaw && bytes > stored) ||
      (encoding == nrrdEncodingGzip && bytes / ByteStream::largestInflation > stored))
  {
    refuse(path, "its data end too early");
  }
  if (!isText && encoding != nrrdEncodingHex && encoding != nrrdEncodingRaw && encoding != nrrdEncodingGzip)
  {
    throw Error("cannot read '" + path + "': its data are compressed in another way than gzip; save them with gzip.");
  }
  return bytes;
}

} // namespace

NrrdFile openNrrdFile(const std::string& path)
{
  Header header = readHeader(path);
  const std::uint64_t bytes = promisedBytes(header, path);
  const NrrdEncoding* const encoding = header.state->encoding;
  if (encoding == nrrdEncodingRaw || encoding == nrrdEncodingGzip)
  {
    const bool deflated = encoding == nrrdEncodingGzip;
    const bool swapped = nrrdTypeSize[header.nrrd->type] > 1 && header.state->endian != airMyEndian();
    ByteStream data(header.data.release(), deflated ? ByteStream::Packing::Deflate : ByteStream::Packing::None, path);
    if (deflated && header.state->byteSkip != 0)
    {
      if (header.state->byteSkip < 0)
      {
        throw Error("cannot read '" + path +
                    "': its header counts bytes from the end of compressed data; save it again.");
      }
      data.skip(std::uint64_t(header.state->byteSkip)); // of inflated bytes
    }
    return { std::move(header.nrrd), swapped, std::move(data) };
  }
  const NrrdPointer whole = loadNrrd(path); // of text there is little
  const char* const first = static_cast<const char*>(whole->data);
  return { std::move(header.nrrd), false, ByteStream(std::vector<char>(first, first + bytes), path) };
}

NrrdPointer loadNrrd(const std::string& path)
{
  promisedBytes(readHeader(path), path);
  const std::lock_guard<std::mutex> lock(teemMutex);
  NrrdPointer nrrd(nrrdNew());
  if (nrrdLoad(nrrd.get(), path.c_str(), nullptr))
  {
    refuse(path, lastTeemMessage());
  }
  return nrrd;
}

} // namespace sono
