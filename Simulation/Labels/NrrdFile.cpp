#include "Labels/NrrdFile.h"

#include "Core/Progress.h"

#include <teem/biff.h>

#include <cstdlib>
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

} // namespace

NrrdPointer loadNrrd(const std::string& path)
{
  const std::lock_guard<std::mutex> lock(teemMutex);
  NrrdPointer nrrd(nrrdNew());
  if (nrrdLoad(nrrd.get(), path.c_str(), nullptr))
  {
    throw Error("cannot read '" + path + "': it is no complete NRRD file (" + lastTeemMessage() + ").");
  }
  return nrrd;
}

} // namespace sono
