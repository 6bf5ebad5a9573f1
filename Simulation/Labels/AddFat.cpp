#include "Labels/AddFat.h"

#include "Core/Error.h"
#include "Core/ParallelFor.h"
#include "Labels/DistanceField.h"
#include "Labels/FreeLabels.h"
#include "Labels/PadLabels.h"

#include <algorithm>
#include <vector>

namespace sono {

namespace {

constexpr double skinMm = 2.0;

/// Whether each label id is of a tissue.
std::vector<char> idsOf(const LabelVolume& volume, const std::string& tissue)
{
  std::vector<char> ids(65536, 0);
  for (const LabelInfo& label : volume.labels)
  {
    ids[std::size_t(label.id)] = label.tissue == tissue ? 1 : 0;
  }
  return ids;
}

int fatIdOf(LabelVolume& volume)
{
  const LabelInfo* fat = nullptr;
  for (const LabelInfo& label : volume.labels)
  {
    const bool isFat = label.tissue == "fat";
    const bool isUnderSkin = label.name.find("subcutaneous") != std::string::npos;
    fat = isFat && (!fat || isUnderSkin) ? &label : fat;
  }
  if (fat)
  {
    return fat->id;
  }
  const int id = freeLabelIds(volume, 1).front();
  addLabel(volume, id, "subcutaneous_fat", { 0.98f, 0.90f, 0.60f });
  volume.labels.back().tissue = "fat";
  return id;
}

std::vector<char> maskOf(const LabelVolume& volume, const std::vector<char>& ids, bool inverse)
{
  std::vector<char> mask(volume.voxels.size());
  std::transform(volume.voxels.begin(), volume.voxels.end(), mask.begin(),
                 [&](std::uint16_t id) { return char((ids[id] != 0) != inverse); });
  return mask;
}

} // namespace

void addFat(LabelVolume& volume, double mm, const std::string& outside)
{
  const Vec3d spacing = volume.placement.spacingMm;
  const double halfVoxelMm = (spacing.x + spacing.y + spacing.z) / 6.0;
  if (mm < halfVoxelMm)
  {
    return;
  }
  const auto isSkin = [](const LabelInfo& label) { return label.tissue == "skin"; };
  const auto skin = std::find_if(volume.labels.begin(), volume.labels.end(), isSkin);
  if (skin == volume.labels.end())
  {
    throw Error("the label map has no skin that more fat could lie under; leave 'extraFatMm' out.");
  }
  const int skinId = skin->id;
  volume = padded(volume, mm);
  const int fatId = fatIdOf(volume);
  const std::vector<char> skinIds = idsOf(volume, "skin");
  const std::vector<char> outsideIds = idsOf(volume, outside);
  const Vec3i size = volume.placement.size;
  const std::vector<float> toBody = distanceTo(maskOf(volume, outsideIds, true), size, spacing);
  const std::vector<float> toSkin = distanceTo(maskOf(volume, skinIds, false), size, spacing);
  const std::vector<float> toOutside = distanceTo(maskOf(volume, outsideIds, false), size, spacing);
  const std::size_t layer = std::size_t(size.x) * size.y;
  parallelFor(size.z, {}, [&](int k) {
    for (std::size_t at = std::size_t(k) * layer; at < std::size_t(k + 1) * layer; ++at)
    {
      // Distances are those of the voxels' centres, half a voxel more than those of the surface.
      const int id = volume.voxels[at];
      if (skinIds[std::size_t(id)])
      {
        const double depthMm = mm + double(toOutside[at]) - halfVoxelMm;
        volume.voxels[at] = std::uint16_t(depthMm > skinMm ? fatId : id);
      }
      else if (outsideIds[std::size_t(id)] && toSkin[at] < toBody[at] + 1e-3f)
      {
        const double depthMm = mm - (double(toBody[at]) - halfVoxelMm);
        volume.voxels[at] = std::uint16_t(depthMm < 0.0 ? id : depthMm > skinMm ? fatId : skinId);
      }
    }
  });
  volume.collectLabels();
}

} // namespace sono
