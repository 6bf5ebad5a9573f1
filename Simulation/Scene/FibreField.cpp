#include "Scene/FibreField.h"

#include "Core/LargeMemory.h"
#include "Core/ParallelFor.h"
#include "Labels/DistanceField.h"
#include "Labels/LabelRuns.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cmath>
#include <string>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int marginVoxels = 2;

std::size_t indexIn(const Vec3i& p, const Vec3i& size)
{
  return std::size_t(p.x) + std::size_t(size.x) * (std::size_t(p.y) + std::size_t(size.y) * std::size_t(p.z));
}

/// Calls visit(voxel, index in the volume, index in the box) for each voxel of a box's slice at k.
template<class Visit>
void forSlice(const VoxelBox& box, int k, const Vec3i& size, const Visit& visit)
{
  std::size_t inBox = indexIn({ 0, 0, k - box.first.z }, box.size());
  for (int j = box.first.y; j < box.last.y; ++j)
  {
    const std::size_t row = indexIn({ 0, j, k }, size);
    for (int i = box.first.x; i < box.last.x; ++i)
    {
      visit(Vec3i(i, j, k), row + std::size_t(i), inBox++);
    }
  }
}

/// Around the muscle, with a margin for derivatives.
VoxelBox muscleBox(const Vec3i& size, const std::vector<std::uint8_t>& tissues, const std::vector<bool>& isMuscle)
{
  const VoxelBox none{ size, Vec3i(0) };
  std::vector<VoxelBox> ofSlices(std::size_t(size.z), none);
  parallelFor(size.z, {}, [&](int k) {
    VoxelBox& own = ofSlices[std::size_t(k)];
    const std::uint8_t* slice = tissues.data() + indexIn({ 0, 0, k }, size);
    forRuns(slice, std::size_t(size.x) * std::size_t(size.y), [&](std::size_t begin, std::size_t end, std::uint8_t t) {
      if (isMuscle[t])
      {
        const int firstRow = int(begin / std::size_t(size.x));
        const int lastRow = int((end - 1) / std::size_t(size.x));
        const bool isOneRow = firstRow == lastRow;
        const int firstX = isOneRow ? int(begin % std::size_t(size.x)) : 0;
        const int lastX = isOneRow ? int((end - 1) % std::size_t(size.x)) : size.x - 1;
        own.first = glm::min(own.first, Vec3i(firstX, firstRow, k));
        own.last = glm::max(own.last, Vec3i(lastX, lastRow, k) + 1);
      }
    });
  });
  VoxelBox box = none;
  for (const VoxelBox& own : ofSlices)
  {
    box = { glm::min(box.first, own.first), glm::max(box.last, own.last) };
  }
  return { glm::max(box.first - marginVoxels, Vec3i(0)), glm::min(box.last + marginVoxels, size) };
}

std::string lowerCase(std::string name)
{
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return name;
}

bool namesLeftVentricle(const std::string& label)
{
  const std::string name = lowerCase(label);
  return name.find("left") != std::string::npos && name.find("ventric") != std::string::npos;
}

bool namesPapillaryMuscle(const std::string& label)
{
  return lowerCase(label).find("papillar") != std::string::npos;
}

/// Eigenvector of the largest eigenvalue, by squaring the matrix until it is all that is left.
Vec3d principalAxis(Mat3d m)
{
  for (int i = 0; i < 40; ++i)
  {
    const double trace = m[0][0] + m[1][1] + m[2][2];
    if (!(trace > 0.0))
    {
      return { 0.0, 0.0, 1.0 };
    }
    m = m / trace;
    m = m * m;
  }
  Vec3d longest(0.0);
  for (int c = 0; c < 3; ++c)
  {
    longest = glm::length(m[c]) > glm::length(longest) ? m[c] : longest;
  }
  return glm::length(longest) > 0.0 ? glm::normalize(longest) : Vec3d(0.0, 0.0, 1.0);
}

/// What the walls of a heart border on.
struct Masks
{
  std::vector<char> left;    // the left ventricle's blood
  std::vector<char> blood;   // other blood
  std::vector<char> outside; // neither blood nor muscle
  bool hasLeft = false;
};

/// Of the voxels of a box of which isPart(index in the volume, index in the box) holds.
template<class IsPart>
Vec3d longAxis(const VoxelBox& box, const Vec3i& size, const Vec3d& spacingMm, const IsPart& isPart)
{
  Vec3d sum(0.0);
  Mat3d products(0.0);
  double count = 0.0;
  for (int k = box.first.z; k < box.last.z; ++k)
  {
    forSlice(box, k, size, [&](const Vec3i& p, std::size_t at, std::size_t n) {
      if (isPart(at, n))
      {
        const Vec3d q = Vec3d(p - box.first) * spacingMm;
        sum += q;
        products += glm::outerProduct(q, q);
        count += 1.0;
      }
    });
  }
  return count > 0.0 ? principalAxis(products / count - glm::outerProduct(sum, sum) / (count * count))
                     : Vec3d(0.0, 0.0, 1.0);
}

/// 0 at the inner surface of the wall, 1 at the outer one. Distances are those of voxels' centres: a surface lies half
/// a voxel nearer.
float wallDepth(float toLeft, float toBlood, float toOutside, float halfVoxel)
{
  const float rest = std::min(toBlood, toOutside);
  const bool isLeft = toLeft + rest <= toBlood + toOutside;
  const float in = std::max(0.0f, (isLeft ? toLeft : toBlood) - halfVoxel);
  const float out = std::max(0.0f, (isLeft ? rest : toOutside) - halfVoxel);
  return in + out > 0.0f ? in / (in + out) : 0.5f;
}

} // namespace

FibreField::FibreField(const VoxelBox& box)
  : box_(box)
  , packed_(largeVector<std::uint32_t>(box.empty() ? 0 : indexIn({ 0, 0, box.size().z }, box.size())))
{
}

void FibreField::set(const Vec3i& voxel, const Vec3d& direction)
{
  std::uint32_t word = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    word |= std::uint32_t(std::lround(128.0 + 127.0 * direction[axis])) << (8 * axis);
  }
  packed_[indexIn(voxel - box_.first, box_.size())] = word;
}

FibreField buildFibreField(const LabelVolume& volume, const std::vector<std::uint8_t>& tissueVoxels,
                           const std::vector<bool>& isMuscle, const std::vector<bool>& isBlood)
{
  const Vec3i size = volume.placement.size;
  const Vec3d spacingMm = volume.placement.spacingMm;
  const VoxelBox box = muscleBox(size, tissueVoxels, isMuscle);
  FibreField field(box);
  if (box.empty())
  {
    return field;
  }
  std::vector<bool> isLeft(65536, false);
  for (const LabelInfo& label : volume.labels)
  {
    isLeft[std::size_t(label.id)] = namesLeftVentricle(label.name);
  }
  const Vec3i boxSize = box.size();
  const std::size_t count = std::size_t(boxSize.x) * std::size_t(boxSize.y) * std::size_t(boxSize.z);
  Masks masks{ largeVector<char>(count), largeVector<char>(count), largeVector<char>(count) };
  std::atomic<bool> hasLeft{ false };
  parallelFor(boxSize.z, {}, [&](int k) {
    bool hasLeftHere = false;
    forSlice(box, box.first.z + k, size, [&](const Vec3i&, std::size_t at, std::size_t n) {
      const bool blood = isBlood[tissueVoxels[at]];
      const bool left = blood && isLeft[volume.voxels[at]];
      masks.left[n] = left;
      masks.blood[n] = blood && !left;
      masks.outside[n] = !blood && !isMuscle[tissueVoxels[at]];
      hasLeftHere |= left;
    });
    if (hasLeftHere)
    {
      hasLeft = true;
    }
  });
  masks.hasLeft = hasLeft;
  const std::vector<char>& cavity = masks.hasLeft ? masks.left : masks.blood;
  const Vec3d axis = longAxis(box, size, spacingMm, [&](std::size_t, std::size_t n) { return cavity[n] != 0; });
  std::vector<float> depth = distanceTo(masks.left, boxSize, spacingMm);
  {
    const std::vector<float> toBlood = distanceTo(masks.blood, boxSize, spacingMm);
    const std::vector<float> toOutside = distanceTo(masks.outside, boxSize, spacingMm);
    const float halfVoxel = 0.5f * float(std::cbrt(spacingMm.x * spacingMm.y * spacingMm.z));
    const std::size_t slice = indexIn({ 0, 0, 1 }, boxSize);
    parallelFor(boxSize.z, {}, [&](int k) {
      for (std::size_t n = slice * std::size_t(k); n < slice * std::size_t(k + 1); ++n)
      {
        // Off the muscle the depth goes on, for the derivatives at its surfaces.
        depth[n] = masks.outside[n] ? 1.0f
                                    : (masks.left[n] || masks.blood[n]
                                         ? (masks.blood[n] && masks.hasLeft && toOutside[n] > depth[n] ? 1.0f : 0.0f)
                                         : wallDepth(depth[n], toBlood[n], toOutside[n], halfVoxel));
      }
    });
  }
  parallelFor(boxSize.z, {}, [&](int k) {
    for (int j = 0; j < boxSize.y; ++j)
    {
      for (int i = 0; i < boxSize.x; ++i)
      {
        const Vec3i p(i, j, k);
        if (!isMuscle[tissueVoxels[indexIn(p + box.first, size)]])
        {
          continue;
        }
        // The wall's own direction over two voxels to either side, each between muscle alone where it can be.
        Vec3d outward(0.0);
        for (int a = 0; a < 3; ++a)
        {
          for (int step = 1; step <= 2; ++step)
          {
            Vec3i low = p;
            Vec3i high = p;
            low[a] = std::max(0, p[a] - step);
            high[a] = std::min(boxSize[a] - 1, p[a] + step);
            outward[a] += double(depth[indexIn(high, boxSize)] - depth[indexIn(low, boxSize)]) / spacingMm[a];
          }
        }
        const Vec3d across = glm::cross(axis, outward);
        if (!(glm::length(across) > 1e-9 * glm::length(outward)) || !(glm::length(outward) > 0.0))
        {
          field.set(p + box.first, axis);
          continue;
        }
        const Vec3d around = glm::normalize(across);
        const Vec3d upwards = glm::cross(glm::normalize(outward), around);
        const double share = double(depth[indexIn(p, boxSize)]);
        const double angle = (fibreAngleInsideDeg + share * (fibreAngleOutsideDeg - fibreAngleInsideDeg)) * pi / 180.0;
        field.set(p + box.first, std::cos(angle) * around + std::sin(angle) * upwards);
      }
    }
  });
  for (const LabelInfo& label : volume.labels)
  {
    if (namesPapillaryMuscle(label.name))
    {
      const auto isPart = [&](std::size_t at, std::size_t) {
        return int(volume.voxels[at]) == label.id && isMuscle[tissueVoxels[at]];
      };
      const Vec3d along = longAxis(box, size, spacingMm, isPart);
      for (int k = box.first.z; k < box.last.z; ++k)
      {
        forSlice(box, k, size, [&](const Vec3i& p, std::size_t at, std::size_t n) {
          if (isPart(at, n))
          {
            field.set(p, along);
          }
        });
      }
    }
  }
  return field;
}

} // namespace sono
