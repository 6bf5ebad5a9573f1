#include "Labels/LabelVolume.h"

#include "Core/ParallelFor.h"
#include "Labels/LabelRuns.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

namespace sono {

namespace {

constexpr double orthonormalTolerance = 1e-3;

bool isPositive(double value)
{
  return std::isfinite(value) && value > 0.0;
}

/// Largest deviation of the columns' scalar products from those of an orthonormal frame.
double orthonormalError(const Mat3d& m)
{
  double worst = 0.0;
  for (int a = 0; a < 3; ++a)
  {
    for (int b = a; b < 3; ++b)
    {
      const double deviation = std::abs(glm::dot(m[a], m[b]) - (a == b ? 1.0 : 0.0));
      worst = std::isfinite(deviation) ? std::max(worst, deviation) : HUGE_VAL;
    }
  }
  return worst;
}

} // namespace

void GridPlacement::validate(const std::string& what) const
{
  if (size.x <= 0 || size.y <= 0 || size.z <= 0)
  {
    throw Error("'" + what + "' has no voxels (" + std::to_string(size.x) + " x " + std::to_string(size.y) + " x " +
                std::to_string(size.z) + "); choose an image with at least one voxel along each axis.");
  }
  if (!isPositive(spacingMm.x) || !isPositive(spacingMm.y) || !isPositive(spacingMm.z))
  {
    throw Error("'" + what + "' has a voxel spacing that is zero, negative or not finite; correct its header.");
  }
  if (!std::isfinite(originMm.x) || !std::isfinite(originMm.y) || !std::isfinite(originMm.z))
  {
    throw Error("'" + what + "' has an origin that is not finite; correct its header.");
  }
  if (orthonormalError(direction) > orthonormalTolerance)
  {
    throw Error("'" + what + "' has axes that are not at right angles; resample it to a grid without shear.");
  }
}

GridPlacement placementFromAffine(const Vec3i& size, const Mat3d& columns, const Vec3d& originMm,
                                  const std::string& what)
{
  GridPlacement placement;
  placement.size = size;
  placement.originMm = originMm;
  for (int axis = 0; axis < 3; ++axis)
  {
    placement.spacingMm[axis] = glm::length(columns[axis]);
    placement.direction[axis] = columns[axis] / placement.spacingMm[axis];
  }
  placement.validate(what);

  // The inverse is taken as the transpose, so what the file's rounding left over must go.
  Mat3d& d = placement.direction;
  const Vec3d thirdAxis = d[2];
  d[1] = glm::normalize(d[1] - glm::dot(d[0], d[1]) * d[0]);
  d[2] = glm::cross(d[0], d[1]);
  if (glm::dot(d[2], thirdAxis) < 0.0)
  {
    d[2] = -d[2];
  }
  return placement;
}

const LabelInfo* LabelVolume::find(int id) const
{
  const auto at = std::lower_bound(labels.begin(), labels.end(), id,
                                   [](const LabelInfo& label, int wanted) { return label.id < wanted; });
  return at != labels.end() && at->id == id ? &*at : nullptr;
}

std::vector<int> LabelVolume::indexOfId() const
{
  std::vector<int> index(65536, 0);
  for (std::size_t l = 0; l < labels.size(); ++l)
  {
    index[std::size_t(labels[l].id)] = int(l);
  }
  return index;
}

void LabelVolume::collectLabels()
{
  constexpr std::size_t together = std::size_t(1) << 22;
  std::vector<char> occurs(65536, 0);
  std::mutex mutex;
  parallelFor(int((voxels.size() + together - 1) / together), {}, [&](int part) {
    std::vector<char> here(occurs.size(), 0);
    const std::size_t first = std::size_t(part) * together;
    forRuns(voxels.data() + first, std::min(together, voxels.size() - first),
            [&](std::size_t, std::size_t, std::uint16_t id) { here[id] = 1; });
    const std::lock_guard<std::mutex> lock(mutex);
    std::transform(here.begin(), here.end(), occurs.begin(), occurs.begin(), [](char a, char b) { return a | b; });
  });
  std::map<int, LabelInfo> known;
  for (LabelInfo& label : labels)
  {
    known[label.id] = std::move(label);
  }
  labels.clear();
  for (int id = 0; id < 65536; ++id)
  {
    if (!occurs[std::size_t(id)])
    {
      continue;
    }
    LabelInfo label = std::move(known[id]);
    label.id = id;
    if (label.name.empty())
    {
      label.name = id == 0 ? "background" : "label_" + std::to_string(id);
    }
    labels.push_back(std::move(label));
  }
}

} // namespace sono
