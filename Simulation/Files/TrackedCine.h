#pragma once

#include "Probe/ScanGeometry.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace sono {

class GreyFrames;

/// What there is to say of a tracked sequence besides its greys.
struct TrackedInfo
{
  int width = 0;
  int height = 0;
  std::array<double, 2> pixelMm{ 1.0, 1.0 }; ///< along the array and into the body
  std::array<double, 2> firstMm{ 0.0, 0.0 }; ///< middle of the first pixel from that of the face
  std::vector<ProbePose> poses;              ///< of each picture; orthonormal
  std::vector<double> timesS;                ///< as many
};

/// A sequence of pictures with a pose each, as PLUS has it: MetaImage (.igs.mha) or NRRD (.igs.nrrd), 8-bit greys, not
/// compressed, orientation MFA. Of each frame time, ImageToProbeTransform (pixels to mm) and ProbeToReferenceTransform:
/// Probe is x lateral, y into the body, z = x x y, 0 in the middle of the face; Reference is the world, LPS mm. The
/// pictures are written one by one; the file appears when all are there, or not at all.
class TrackedCine
{
public:
  /// Throws Error naming the path where it cannot be written, its ending is another one, or there are no pictures.
  TrackedCine(const std::string& path, const TrackedInfo& info);
  ~TrackedCine();

  /// The next picture, the row at the face first. Throws Error for another size, one too many, and a full disk.
  void add(const std::uint8_t* grey, int width, int height);
  /// Throws Error where pictures are missing, or the disk is full.
  void finish();

private:
  std::unique_ptr<GreyFrames> frames_;
};

} // namespace sono
