#pragma once

#include "Kernel/LeftSurface.h"
#include "Kernel/SurfaceHit.h"

// The voxels of a smooth surface are a staircase: near it, a ray meets voxels of the tissue behind it although it goes
// away from it. These stairs of the surface left last do not count, and the march passes them.

namespace sono {

/// Tells the stairs of the surface that a path has left, and remembers where the ray went in among them: where it turns
/// out there that they were none, the surface was met where they begin.
class StairsLeft
{
public:
  /// Where the ray has left the stairs' reach before a surface that bends towards it with a radius of six voxels could
  /// be met, whatever is of the tissue left is a stair until `passedMm`. Behind `toldMm` no stairs begin.
  template<class Cells>
  SONO_HD StairsLeft(const Cells& cells, const CellRay& ray, const LeftSurface& left)
    : left_(left)
  {
    const Vec3f n = left.normal();
    const float cosine = larger(glm::dot(n, ray.direction), 1e-3f);
    const float reach = 0.5f * glm::dot(glm::abs(n), cells.spacing) + slackVoxels * cells.meanSpacing - left.heightMm;
    const float soonest = smaller(clearVoxels, 12.0f * cosine) * cells.meanSpacing;
    passedMm_ = left.isThere() && reach < soonest * cosine ? reach / cosine : 0.0f;
    toldMm_ = smaller(clearVoxels * cells.meanSpacing, (highestVoxels * cells.meanSpacing + reach) / cosine);
  }
  SONO_HD int tissue() const { return left_.tissue(); }
  /// Whether a voxel of another tissue than the path's, met at `t`, is a stair for sure.
  SONO_HD bool passes(int tissueMet, float t) const { return tissueMet == tissue() && t < passedMm_; }
  /// Whether the voxel that was met is a stair. `word` is its word; `fromStair`: so was the voxel before.
  template<class Cells>
  SONO_HD bool pass(const Cells& cells, const CellRay& ray, const CellHit& hit, bool fromStair, std::uint32_t word)
  {
    if ((!fromStair && hit.t >= toldMm_) || !isStair(cells, ray, hit, word, fromStair))
    {
      return false;
    }
    entrance_ = fromStair ? entrance_ : hit;
    return true;
  }
  /// Where the ray met a surface, if its march ends with this hit.
  SONO_HD CellHit met(const CellHit& hit, bool fromStair)
  {
    again_ = fromStair && entrance_.tissue < 0;
    return fromStair ? entrance_ : hit;
  }
  /// Whether a march must be done again, since the surface was met among stairs that it has passed without telling
  /// them.
  SONO_HD bool again()
  {
    const bool again = again_;
    again_ = false;
    passedMm_ = 0.0f;
    entrance_.tissue = -1;
    return again;
  }

private:
  static constexpr float clearVoxels = 8.0f;
  static constexpr float slackVoxels = 0.3f;
  static constexpr float highestVoxels = 0.5f;

  /// Behind the plane of the surface left, or no further in front of it than voxels and a smoothed surface are apart,
  /// lie all stairs of a surface that does not bend towards the path. Of others their own record tells that the ray
  /// does not enter the surface there, by more than normals err.
  template<class Cells>
  SONO_HD bool isStair(const Cells& cells, const CellRay& ray, const CellHit& hit, std::uint32_t word,
                       bool inStair) const
  {
    constexpr float normalError = 0.04f; // 2 degrees
    constexpr float least = 0.15f;
    constexpr float off = 0.8f;
    if ((word & 0x8000u) == 0u) // touches no other tissue
    {
      return false;
    }
    const Vec3f n = left_.normal();
    const float slack = slackVoxels * cells.meanSpacing;
    const bool isNear = hit.t < clearVoxels * cells.meanSpacing;
    const Vec3f centre = (Vec3f(hit.after) + Vec3f(0.5f)) * cells.spacing - ray.position;
    if (isNear && glm::dot(n, centre) + left_.heightMm < slack)
    {
      return true;
    }
    const std::uint32_t bits = cells.recordOf(hit.after.x, hit.after.y, hit.after.z, word);
    if (decodeConfidence(bits) > least)
    {
      return -glm::dot(ray.direction, decodeOctahedral(bits)) < normalError;
    }
    // In thin walls records do not tell; there no stair of the surface left is behind a face through which the way
    // leads off from it, nor further above it than stairs reach.
    const float reach = 0.5f * glm::dot(glm::abs(n), cells.spacing) + slack;
    const float leaving = larger(fabsf(glm::dot(n, ray.direction)), 0.1f);
    return isNear && left_.heightMm + leaving * hit.t < reach && (inStair || glm::dot(stepOf(ray, hit), n) < off);
  }

  LeftSurface left_;
  float passedMm_;
  float toldMm_;
  bool again_ = false;
  CellHit entrance_ = noHit(0.0f, Vec3i(0), 0); ///< where the ray went in among the stairs told last; none yet
};

} // namespace sono
