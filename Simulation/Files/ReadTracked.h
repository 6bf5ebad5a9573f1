#pragma once

#include "Probe/ScanGeometry.h"

#include <glm/mat4x4.hpp>

#include <string>
#include <vector>

namespace sono {

using Mat4d = glm::dmat4; ///< of columns, the last the origin

/// Where the probe was when a tracked sequence was recorded.
struct TrackedPoses
{
  std::vector<ProbePose> poses; ///< orthonormal
  std::vector<double> timesS;   ///< as many
  std::vector<int> frames;      ///< their numbers in the file, from 0
  int invalidCount = 0;         ///< frames without a pose: the tracker did not see the probe
};

/// The poses of a sequence of PLUS (.igs.mha, .igs.nrrd and the older .mha and .nrrd), whose pictures are not read.
/// `transform` is as ProbeToReference; where the frames do not have it, it is put together of those that they have and
/// their inverses (ProbeToTracker, then back by ReferenceToTracker). A pose is worldFromReference x transform x
/// probeFromOurs; ours is x lateral, y into the body, mm, 0 in the middle of the face, and the world is LPS mm. Throws
/// Error naming the file for one that is no such sequence, and where no frame has the transform, with those that there
/// are.
TrackedPoses readTracked(const std::string& path, const std::string& transform, const Mat4d& probeFromOurs,
                         const Mat4d& worldFromReference);

} // namespace sono
