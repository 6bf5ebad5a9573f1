#pragma once

#include "Probe/ScanGeometry.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace sono {

/// A picture as a live link sends it.
struct LinkPicture
{
  int width = 0;
  int height = 0;
  double pixelMm = 1.0;
  std::array<double, 2> firstMm{ 0.0, 0.0 }; ///< middle of the first pixel from that of the face, lateral and axial
  ProbePose pose;                            ///< orthonormal
  std::vector<std::uint8_t> grey;            ///< the row at the face first
};

// Messages of OpenIGTLink, packed and taken apart by its library. Its world is RAS, this one's is LPS: x and y change
// their signs here, and nowhere else.

/// Throws Error where this program was built without OpenIGTLink.
void requireLinkLibrary();

/// IMAGE "SonoVDB", where it stands in the world, and TRANSFORM "SonoProbeToReference": x lateral, y into the
/// body, z = x x y, mm, 0 in the middle of the face.
std::string linkMessages(const LinkPicture& picture);

constexpr std::size_t linkHeaderBytes = 58;

/// What stands before a message.
struct LinkHeader
{
  std::string type; ///< "TRANSFORM"
  std::string device;
  std::uint64_t bodyBytes = 0;
};

/// Empty where these bytes begin no message.
std::optional<LinkHeader> readLinkHeader(const char* bytes);

/// The pose that a TRANSFORM message says, header and body. Throws Error for one that is damaged, mirrors, or is of
/// another size than 1.
ProbePose readLinkPose(const std::string& message);

} // namespace sono
