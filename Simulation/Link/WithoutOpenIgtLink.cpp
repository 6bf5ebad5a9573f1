#include "Core/Error.h"
#include "Link/LinkMessages.h"

namespace sono {

void requireLinkLibrary()
{
  throw Error("This SonoVDB was built without OpenIGTLink; install libopenigtlink-dev and build it again.");
}

// Nobody comes here without that.

std::string linkMessages(const LinkPicture&)
{
  return {};
}

std::optional<LinkHeader> readLinkHeader(const char*)
{
  return std::nullopt;
}

ProbePose readLinkPose(const std::string&)
{
  return {};
}

} // namespace sono
