#include "Phantoms/ThoraxPhantom.h"

#include "Core/Error.h"
#include "Core/ParallelFor.h"
#include "Phantoms/BeatingHeart.h"
#include "Phantoms/ThoraxAorta.h"
#include "Phantoms/ThoraxChest.h"
#include "Phantoms/ThoraxHeart.h"

#include <glm/common.hpp>

#include <sstream>
#include <string>
#include <vector>

namespace sono {

namespace {

/// The heart's frame in the world: origin on the skin over the apex, columns lateral, elevation, axial.
struct HeartFrame
{
  Vec3d originMm;
  Mat3d axes;

  Vec3d fromWorld(const Vec3d& p) const { return glm::transpose(axes) * (p - originMm); }
  Vec3d toWorld(const Vec3d& q) const { return originMm + axes * q; }
};

HeartFrame heartFrame()
{
  // The fifth left intercostal space, in front of the mid-axillary line. The heart's long axis goes from there to the
  // right, back and up.
  const Vec3d axial = glm::normalize(Vec3d(-0.53, 0.65, 0.545));
  const Vec3d leftward(0.84, 0.33, 0.42);
  const Vec3d lateral = glm::normalize(leftward - glm::dot(leftward, axial) * axial);
  return { skinPointMm(88.0, -86.7, -45.0), Mat3d(lateral, glm::cross(axial, lateral), axial) };
}

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

GridPlacement placementFor(double spacingMm)
{
  const Vec3d extentMm = thoraxBoxHighMm() - thoraxBoxLowMm();
  GridPlacement placement;
  placement.size = Vec3i(glm::round(extentMm / spacingMm));
  placement.spacingMm = Vec3d(spacingMm);
  placement.originMm = thoraxBoxLowMm() + 0.5 * spacingMm;
  return placement;
}

/// Everything that does not change from voxel to voxel.
class Anatomy
{
public:
  ThoraxLabel sample(const Vec3d& p) const
  {
    const Vec3d q = frame_.fromWorld(p);
    const Vec3d fromHeart = q - heartSphereCentreMm();
    HeartSample heart;
    if (glm::dot(fromHeart, fromHeart) < heartSphereRadiusMm() * heartSphereRadiusMm())
    {
      heart = sampleHeart(q);
    }
    if (const ThoraxLabel vessel = aorta_.sample(p))
    {
      heart.label = vessel;
    }
    return sampleChest(p, heart, q);
  }

private:
  HeartFrame frame_ = heartFrame();
  ThoraxAorta aorta_{ frame_.toWorld(aorticValveCentreMm()), frame_.axes* aorticFlowDirection() };
};

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

LabelVolume makeThoraxPhantom(double spacingMm, double phase)
{
  if (!(spacingMm >= 0.5 && spacingMm <= 5.0))
  {
    std::ostringstream message;
    message << "The bundled thorax cannot have a voxel size of " << spacingMm << " mm; choose 0.5 to 5 mm.";
    throw Error(message.str());
  }
  const Anatomy anatomy;
  LabelVolume volume;
  volume.placement = placementFor(spacingMm);
  volume.voxels.resize(volume.placement.voxelCount());
  const Vec3i size = volume.placement.size;
  parallelFor(size.z, {}, [&](int k) {
    std::uint16_t* voxel = volume.voxels.data() + std::size_t(k) * size.x * size.y;
    for (int j = 0; j < size.y; ++j)
    {
      for (int i = 0; i < size.x; ++i)
      {
        const Vec3d now = volume.placement.worldFromIndex(Vec3d(i, j, k));
        *voxel++ = anatomy.sample(phase == 0.0 ? now : thoraxRestingPlaceMm(now, phase));
      }
    }
  });
  volume.labels = labelsOf(volume.voxels);
  return volume;
}

Vec3d thoraxRestingPlaceMm(const Vec3d& world, double phase)
{
  static const HeartFrame frame = heartFrame();
  const Vec3d now = frame.fromWorld(world);
  const Vec3d resting = heartRestingPlaceMm(now, phase);
  return resting == now ? world : frame.toWorld(resting); // what stands still does so to the last digit
}

std::vector<Vec3f> thoraxDisplacementMm(const GridPlacement& grid, double phase)
{
  std::vector<Vec3f> displacementMm(grid.voxelCount(), Vec3f(0.0f));
  parallelFor(grid.size.z, {}, [&](int k) {
    Vec3f* to = displacementMm.data() + std::size_t(k) * grid.size.x * grid.size.y;
    for (int j = 0; j < grid.size.y; ++j)
    {
      for (int i = 0; i < grid.size.x; ++i)
      {
        const Vec3d now = grid.worldFromIndex(Vec3d(i, j, k));
        *to++ = Vec3f(now - thoraxRestingPlaceMm(now, phase));
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

ProbePose thoraxPhantomA4C()
{
  constexpr double insetMm = 0.5; // the face touches the skin from inside, so that every line starts in tissue
  const HeartFrame frame = heartFrame();
  ProbePose pose;
  pose.axial = frame.axes[2];
  pose.lateral = frame.axes[0];
  pose.positionMm = frame.originMm;
  const Vec3d inward = glm::normalize(Vec3d(-frame.originMm.x, -frame.originMm.y, 0.0));
  pose.positionMm += insetMm * inward;
  return pose;
}

} // namespace sono
