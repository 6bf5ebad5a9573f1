#pragma once

#include "Kernel/Vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sono {

/// Where a voxel grid stands in the world. World coordinates are LPS millimetres (x to the patient's left,
/// y posterior, z superior), as in DICOM and NRRD. The CENTRE of voxel (i,j,k) lies at
/// origin + direction * (spacing * (i,j,k)).
struct GridPlacement
{
  Vec3i size{ 0, 0, 0 };           ///< voxels along i, j, k
  Vec3d originMm{ 0.0, 0.0, 0.0 }; ///< centre of voxel (0,0,0)
  Vec3d spacingMm{ 1.0, 1.0, 1.0 };
  Mat3d direction{ 1.0 }; ///< columns are the unit world directions of i, j, k; may be left-handed
  /// Which world: DICOM's Frame of Reference UID. Empty where the file names none. Places in two different ones cannot
  /// be compared.
  std::string frameOfReference;

  Vec3d worldFromIndex(const Vec3d& ijk) const { return originMm + direction * (spacingMm * ijk); }
  Vec3d indexFromWorld(const Vec3d& world) const
  {
    return (glm::transpose(direction) * (world - originMm)) / spacingMm;
  }
  std::size_t voxelCount() const { return std::size_t(size.x) * size.y * size.z; }

  /// Throws Error when a size or spacing is not positive and finite, or the direction is not orthonormal
  /// within 1e-3; `what` names the source (a file) in the message.
  void validate(const std::string& what) const;
};

/// A placement from the world steps of one voxel along i, j, k (`columns`, mm). Rounding in the file is removed: the
/// direction is orthonormal to double precision. Throws Error naming `what` when the steps are zero, not finite, or
/// sheared (not at right angles within 1e-3).
GridPlacement placementFromAffine(const Vec3i& size, const Mat3d& columns, const Vec3d& originMm,
                                  const std::string& what);

/// One label of a label map.
struct LabelInfo
{
  int id = 0;           ///< the number in the voxels, 0 to 65535
  std::string name;     ///< as the file gives it, or "label_<id>"
  std::string code;     ///< of a terminology, SCHEME VALUE such as "SCT 64033007"; empty: none
  std::string tissue;   ///< a name of the tissue table; empty until assignTissues
  bool guessed = false; ///< whether that tissue is a guess (assignTissues), for a person to look at
  std::array<float, 3> color{ 0.5f, 0.5f, 0.5f };
  bool hasColor = false; ///< whether the file gave the colour
};

/// A label map: one label id per voxel, i fastest. `labels` holds every id that occurs in `voxels`, ascending.
struct LabelVolume
{
  GridPlacement placement;
  std::vector<std::uint16_t> voxels;
  std::vector<LabelInfo> labels;
  std::string notice; ///< a sentence on how it was read that a person should know; empty: none

  /// nullptr when no voxel carries the id.
  const LabelInfo* find(int id) const;

  /// Index in `labels` of each id that a voxel can have: 65,536 entries, 0 where no label has it.
  std::vector<int> indexOfId() const;

  /// Rebuilds `labels` from the voxels: keeps names that are there, adds "label_<id>" for the others
  /// ("background" for 0), drops ids without voxels.
  void collectLabels();
};

/// The label maps of one file, one after the other in time.
struct LabelPhases
{
  int count = 1;
  double stepS = 1.0; ///< time between two, s; 1 where the file does not say
};

} // namespace sono
