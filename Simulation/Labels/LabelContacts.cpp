#include "Labels/LabelContacts.h"

#include <algorithm>

namespace sono {

namespace {

/// Calls visit(i, j) for the indices of each two voxels that share a face and differ.
template<class Visit>
void forFaces(const LabelVolume& volume, const Visit& visit)
{
  const Vec3i size = volume.placement.size;
  const std::size_t steps[3] = { 1, std::size_t(size.x), std::size_t(size.x) * size.y };
  Vec3i v(0);
  std::size_t here = 0;
  for (v.z = 0; v.z < size.z; ++v.z)
  {
    for (v.y = 0; v.y < size.y; ++v.y)
    {
      for (v.x = 0; v.x < size.x; ++v.x, ++here)
      {
        for (int axis = 0; axis < 3; ++axis)
        {
          const std::size_t next = here + steps[axis];
          if (v[axis] + 1 < size[axis] && volume.voxels[here] != volume.voxels[next])
          {
            visit(here, next);
          }
        }
      }
    }
  }
}

Vec3i placeOf(const Vec3i& size, std::size_t index)
{
  return { int(index % size.x), int(index / size.x % size.y), int(index / size.x / size.y) };
}

bool mayBe(const LabelVolume& volume, const LabelContacts& contacts, std::size_t index, int label)
{
  const Vec3i size = volume.placement.size;
  const Vec3i v = placeOf(size, index);
  std::size_t step = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool fits = (v[axis] == 0 || contacts.touch(label, volume.voxels[index - step])) &&
                      (v[axis] + 1 == size[axis] || contacts.touch(label, volume.voxels[index + step]));
    if (!fits)
    {
      return false;
    }
    step *= std::size_t(size[axis]);
  }
  return true;
}

} // namespace

LabelContacts::LabelContacts(const LabelVolume& volume)
{
  std::uint32_t last = 0;
  forFaces(volume, [&](std::size_t a, std::size_t b) {
    const std::uint32_t key = keyOf(volume.voxels[a], volume.voxels[b]);
    if (key != last)
    {
      pairs_.insert(key);
      last = key;
    }
  });
}

std::size_t keepApart(LabelVolume& resampled, const LabelContacts& original,
                      const std::function<std::vector<std::uint16_t>(const Vec3i&)>& candidates)
{
  const Vec3i size = resampled.placement.size;
  const auto change = [&](std::size_t index) {
    const std::vector<std::uint16_t> labels = candidates(placeOf(size, index));
    const auto label = std::find_if(labels.begin(), labels.end(),
                                    [&](std::uint16_t id) { return mayBe(resampled, original, index, id); });
    if (label == labels.end())
    {
      return false;
    }
    resampled.voxels[index] = *label;
    return true;
  };
  std::size_t left = 0;
  forFaces(resampled, [&](std::size_t a, std::size_t b) {
    const bool isApart = original.touch(resampled.voxels[a], resampled.voxels[b]) || change(a) || change(b);
    left += isApart ? 0 : 1;
  });
  return left;
}

} // namespace sono
