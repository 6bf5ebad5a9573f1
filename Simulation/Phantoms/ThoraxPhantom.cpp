#include "Phantoms/ThoraxPhantom.h"

#include "Core/Error.h"
#include "Core/ParallelFor.h"
#include "Phantoms/ThoraxBody.h"

#include <glm/common.hpp>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace sono {

namespace {

struct NamedColour
{
  const char* name;
  int red, green, blue;
};

/// In the order of ThoraxLabel, up to the ribs.
constexpr NamedColour palette[RibLeft1] = {
  { "background", 0, 0, 0 },
  { "skin", 245, 199, 171 },
  { "subcutaneous_fat", 250, 230, 153 },
  { "muscle", 140, 64, 56 },
  { "sternum", 240, 234, 225 },
  { "costal_cartilages", 152, 213, 211 },
  { "vertebrae", 236, 230, 210 },
  { "spinal_cord", 230, 229, 128 },
  { "lung_left", 95, 130, 181 },
  { "lung_right", 83, 145, 175 },
  { "mediastinal_fat", 242, 217, 115 },
  { "pericardium", 225, 225, 190 },
  { "left_ventricle_myocardium", 184, 107, 89 },
  { "interventricular_septum", 204, 153, 115 },
  { "right_ventricle_myocardium", 153, 102, 128 },
  { "left_atrium_wall", 204, 140, 128 },
  { "right_atrium_wall", 153, 128, 178 },
  { "interatrial_septum", 190, 150, 160 },
  { "left_ventricle_blood", 217, 26, 26 },
  { "right_ventricle_blood", 38, 64, 204 },
  { "left_atrium_blood", 255, 128, 128 },
  { "right_atrium_blood", 115, 140, 255 },
  { "mitral_valve", 255, 255, 230 },
  { "tricuspid_valve", 255, 255, 230 },
  { "aortic_valve", 255, 255, 230 },
  { "papillary_muscle_lv_anterolateral", 128, 217, 76 },
  { "papillary_muscle_lv_posteromedial", 102, 191, 51 },
  { "papillary_muscle_rv", 153, 230, 102 },
  { "aorta_lumen", 242, 76, 26 },
  { "aorta_wall", 217, 166, 140 },
  { "liver", 109, 64, 25 },
  { "stomach", 187, 137, 134 },
  { "visceral_fat_abdomen", 230, 199, 89 },
};

LabelInfo labelInfo(int id)
{
  NamedColour entry{ "", 242, 238, 218 };
  LabelInfo info;
  info.id = id;
  info.hasColor = true;
  if (id < RibLeft1)
  {
    entry = palette[id];
    info.name = entry.name;
  }
  else
  {
    const bool left = id < RibRight1;
    info.name = (left ? "rib_left_" : "rib_right_") + std::to_string(id - (left ? RibLeft1 : RibRight1) + 1);
  }
  info.color = { entry.red / 255.0f, entry.green / 255.0f, entry.blue / 255.0f };
  return info;
}

GridPlacement placementFor(const ChestShape& chest, double spacingMm)
{
  const Vec3d lowMm = thoraxBoxLowMm(chest);
  const Vec3d extentMm = thoraxBoxHighMm(chest) - lowMm;
  GridPlacement placement;
  placement.size = Vec3i(glm::round(extentMm / spacingMm));
  placement.spacingMm = Vec3d(spacingMm);
  placement.originMm = lowMm + 0.5 * spacingMm;
  return placement;
}

/// The labels that occur among the voxels, ascending.
std::vector<LabelInfo> labelsOf(const std::vector<std::uint16_t>& voxels)
{
  std::vector<bool> present(ThoraxLabelCount, false);
  for (const std::uint16_t id : voxels)
  {
    present[id] = true;
  }
  std::vector<LabelInfo> labels;
  for (int id = 0; id < ThoraxLabelCount; ++id)
  {
    if (present[id])
    {
      labels.push_back(labelInfo(id));
    }
  }
  return labels;
}

} // namespace

LabelVolume makeThoraxPhantom(double spacingMm, const ThoraxParameters& parameters)
{
  if (!(spacingMm >= 0.5 && spacingMm <= 5.0))
  {
    std::ostringstream message;
    message << "The bundled thorax cannot have a voxel size of " << spacingMm << " mm; choose 0.5 to 5 mm.";
    throw Error(message.str());
  }
  const ThoraxBody body(parameters);
  LabelVolume volume;
  volume.placement = placementFor(body.chest(), spacingMm);
  volume.voxels = body.labels(volume.placement);
  volume.labels = labelsOf(volume.voxels);
  return volume;
}

std::vector<Vec3f> thoraxDisplacementMm(const GridPlacement& grid, const ThoraxParameters& parameters)
{
  const ThoraxBody body(parameters);
  std::vector<Vec3f> displacementMm(grid.voxelCount(), Vec3f(0.0f));
  parallelFor(grid.size.z, {}, [&](int k) {
    Vec3f* to = displacementMm.data() + std::size_t(k) * grid.size.x * grid.size.y;
    for (int j = 0; j < grid.size.y; ++j)
    {
      for (int i = 0; i < grid.size.x; ++i)
      {
        const Vec3d now = grid.worldFromIndex(Vec3d(i, j, k));
        *to++ = Vec3f(now - body.restingPlaceMm(now));
      }
    }
  });
  return displacementMm;
}

const std::set<int>& thoraxMovingLabels()
{
  static const std::set<int> labels{ Pericardium,
                                     LeftVentricleMyocardium,
                                     InterventricularSeptum,
                                     RightVentricleMyocardium,
                                     LeftAtriumWall,
                                     RightAtriumWall,
                                     InteratrialSeptum,
                                     MitralValve,
                                     TricuspidValve,
                                     AorticValve,
                                     PapillaryMuscleAnterolateral,
                                     PapillaryMusclePosteromedial,
                                     PapillaryMuscleRight,
                                     AortaWall };
  return labels;
}

ProbePose thoraxPhantomA4C(const ThoraxParameters& parameters)
{
  constexpr double insetMm = 0.5; // the face touches the skin from inside, so that every line starts in tissue
  const HeartFrame frame = heartFrame(parameters);
  const ChestShape chest = chestShape(parameters);
  ProbePose pose;
  pose.axial = frame.axes[2];
  pose.lateral = frame.axes[0];
  pose.positionMm = frame.originMm;
  for (int round = 0; round < 50 && std::abs(skinDepthMm(pose.positionMm, chest)) > 1e-6; ++round)
  {
    pose.positionMm -= skinDepthMm(pose.positionMm, chest) * pose.axial;
  }
  const Vec3d inward = glm::normalize(Vec3d(-frame.originMm.x, -frame.originMm.y, 0.0));
  pose.positionMm += insetMm * inward;
  return pose;
}

} // namespace sono
