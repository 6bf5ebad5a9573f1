#include "Scene/BoundaryFits.h"

#include "Core/Simd.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

using namespace stepfit;

// Windows that tell a normal better than smoothing does: of planes in columns to each side, of what is bent in widths
// of that smoothing.
constexpr float leastOfPlane = 40.0f;
constexpr float leastOfBent = 9.0f;
constexpr float mostReach = 0.33f; // of a window, to the voxels that its fit serves
constexpr float mostMiss = 0.6f;   // voxels from a fit to the step of a voxel that it serves
constexpr float steepest = 1.3f;   // voxels from a column's step to the next
constexpr int mostFits = 3;        // of the faces of a kind
constexpr float sameWay = 0.96f;   // cosine between fits that both hold

SONO_SIMD_CLONES __attribute__((flatten)) StarFit fitStar(StepStar& star, const Vec3i& voxel, int axis, float leastBent)
{
  return star.fit(voxel, axis, leastOfPlane, leastBent);
}

} // namespace

BoundaryFits::BoundaryFits(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm, double smoothingMm)
  : tissues_(tissues)
  , size_(size)
  , pitch_{ 1, size.x, std::ptrdiff_t(size.x) * size.y }
  , spacing_(spacingMm)
  , smoothing_(float(smoothingMm))
  , star_(tissues, size)
{
}

void BoundaryFits::find(const Vec3i& first)
{
  fits_.clear();
  findFaces(first);
  // The axis whose columns see most of a boundary first; others then have the less to do.
  std::stable_sort(kinds_.begin(), kinds_.end(),
                   [](const KindCount& a, const KindCount& b) { return a.faces > b.faces; });
  for (const KindCount& each : kinds_)
  {
    fitFaces(each.kind);
  }
}

void BoundaryFits::findFaces(const Vec3i& first)
{
  faces_.clear();
  kinds_.clear();
  const Vec3i last = glm::min(first + recordBlock, size_);
  for (int axis = 0; axis < 3; ++axis)
  {
    Vec3i low = first;
    low[axis] = std::max(0, first[axis] - 1);
    Vec3i high = last;
    high[axis] = std::min(last[axis], size_[axis] - 1);
    for (int k = low.z; k < high.z; ++k)
    {
      for (int j = low.y; j < high.y; ++j)
      {
        const std::uint8_t* row = tissues_ + pitch_[1] * j + pitch_[2] * k;
        for (int i = low.x; i < high.x; ++i)
        {
          if (row[i] != row[i + pitch_[axis]])
          {
            const Kind kind{ std::uint8_t(axis), row[i], row[i + pitch_[axis]] };
            faces_.push_back({ Vec3i(i, j, k), kind });
            const auto known =
              std::find_if(kinds_.begin(), kinds_.end(), [&](const KindCount& each) { return each.kind == kind; });
            if (known == kinds_.end())
            {
              kinds_.push_back({ kind, 1 });
            }
            else
            {
              ++known->faces;
            }
          }
        }
      }
    }
  }
}

StarFit BoundaryFits::fitAt(const Vec3i& voxel, int axis)
{
  const float across = std::min(spacing_[(axis + 1) % 3], spacing_[(axis + 2) % 3]);
  const StarFit fit = fitStar(star_, voxel, axis, leastOfBent * smoothing_ / across);
  const bool isSteep = std::max(std::fabs(fit.height.c1), std::fabs(fit.height.c2)) > steepest;
  return isSteep ? StarFit{} : fit;
}

void BoundaryFits::fitFaces(const Kind& kind)
{
  open_.clear();
  Vec3f served(0.0f);
  for (const Face& face : faces_)
  {
    if (face.kind == kind && !normalAt(face.voxel, served))
    {
      open_.push_back(face.voxel);
    }
  }
  for (int n = 0; n < mostFits && !open_.empty(); ++n)
  {
    Vec3i sum(0);
    for (const Vec3i& voxel : open_)
    {
      sum += voxel;
    }
    const Vec3f middle = Vec3f(sum) / float(open_.size());
    const auto away = [&](const Vec3i& voxel) {
      const Vec3f d = Vec3f(voxel) - middle;
      return glm::dot(d, d);
    };
    const Vec3i seed =
      *std::min_element(open_.begin(), open_.end(), [&](const Vec3i& a, const Vec3i& b) { return away(a) < away(b); });
    const Fit fit{ kind, seed, fitAt(seed, kind.axis) };
    if (fit.star.radius == 0)
    {
      return;
    }
    fits_.push_back(fit);
    open_.erase(std::remove_if(open_.begin(), open_.end(), [&](const Vec3i& voxel) { return holds(fit, voxel); }),
                open_.end());
  }
}

/// Whether the step of the face above a voxel, of the fit's kind, is one that the fit makes.
bool BoundaryFits::holds(const Fit& fit, const Vec3i& voxel) const
{
  const int axis = fit.kind.axis;
  const float i = float(voxel[(axis + 1) % 3] - fit.voxel[(axis + 1) % 3]);
  const float j = float(voxel[(axis + 2) % 3] - fit.voxel[(axis + 2) % 3]);
  const float reach = mostReach * float(fit.star.radius);
  return i * i + j * j <= reach * reach &&
         std::fabs(float(voxel[axis] - fit.voxel[axis]) - fit.star.height.at(i, j)) <= mostMiss;
}

/// The voxel below the face that a voxel has along a fit's axis, or that the next one of its column has: on a slope
/// some voxels have a face to their side alone. False where there is none of the fit's kind.
bool BoundaryFits::findFace(const Kind& kind, bool isBelow, Vec3i& voxel) const
{
  const int axis = kind.axis;
  const int away = isBelow ? 1 : -1;
  voxel[axis] -= isBelow ? 0 : 1;
  for (int n = 0; n < 2; ++n, voxel[axis] += away)
  {
    const std::uint8_t* t = tissues_ + voxel.x + pitch_[1] * voxel.y + pitch_[2] * voxel.z;
    if (voxel[axis] >= 0 && voxel[axis] + 1 < size_[axis] && t[0] == kind.below && t[pitch_[axis]] == kind.above)
    {
      return true;
    }
  }
  return false;
}

bool BoundaryFits::normalAt(const Vec3i& voxel, Vec3f& outward) const
{
  const std::uint8_t tissue = tissues_[voxel.x + pitch_[1] * voxel.y + pitch_[2] * voxel.z];
  int widest = 0;
  for (const Fit& fit : fits_)
  {
    const bool isBelow = fit.kind.below == tissue;
    Vec3i face = voxel;
    if ((!isBelow && fit.kind.above != tissue) || !findFace(fit.kind, isBelow, face) || !holds(fit, face))
    {
      continue;
    }
    const int axis = fit.kind.axis;
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const Quadratic& q = fit.star.height;
    const float i = float(voxel[u] - fit.voxel[u]);
    const float j = float(voxel[v] - fit.voxel[v]);
    Vec3f normal(0.0f);
    normal[axis] = 1.0f / spacing_[axis];
    normal[u] = -(q.c1 + 2.0f * q.c3 * i + q.c5 * j) / spacing_[u];
    normal[v] = -(q.c2 + 2.0f * q.c4 * j + q.c5 * i) / spacing_[v];
    normal = glm::normalize(normal) * (isBelow ? 1.0f : -1.0f);
    if (widest > 0 && glm::dot(normal, outward) < sameWay)
    {
      return false; // an edge: the smoothing rounds it
    }
    if (fit.star.radius > widest)
    {
      widest = fit.star.radius;
      outward = normal;
    }
  }
  return widest > 0;
}

} // namespace sono
