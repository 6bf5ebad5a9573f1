#pragma once

#include "Probe/ScanGeometry.h"
#include "Scene/Scene.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace sono::test {

/// A tissue without scatterers.
inline Tissue makeTissue(const std::string& name, double impedance, double speed, double attenuation)
{
  Tissue t;
  t.name = name;
  t.impedanceMRayl = impedance;
  t.soundSpeedMPerS = speed;
  t.attenuationDbPerCmMHz = attenuation;
  return t;
}

/// A scene whose label at a voxel centre (local mm) is given by a function; label i has the i-th tissue.
inline std::unique_ptr<Scene> makeScene(const Vec3i& size, const Vec3d& spacingMm, const std::vector<Tissue>& tissues,
                                        const std::function<int(const Vec3d&)>& labelAt,
                                        const std::string& outside = "none")
{
  LabelVolume volume;
  volume.placement.size = size;
  volume.placement.spacingMm = spacingMm;
  volume.placement.originMm = spacingMm * 0.5; // local and world coordinates coincide
  volume.voxels.resize(volume.placement.voxelCount());
  std::size_t at = 0;
  for (int k = 0; k < size.z; ++k)
  {
    for (int j = 0; j < size.y; ++j)
    {
      for (int i = 0; i < size.x; ++i)
      {
        volume.voxels[at++] = std::uint16_t(labelAt((Vec3d(i, j, k) + 0.5) * spacingMm));
      }
    }
  }
  volume.collectLabels();
  TissueTable table;
  for (const Tissue& t : tissues)
  {
    table.add(t);
  }
  for (LabelInfo& label : volume.labels)
  {
    label.tissue = tissues[std::size_t(label.id)].name;
  }
  return std::make_unique<Scene>(std::move(volume), table, outside);
}

/// One scan line.
inline ScanLine makeLine(const Vec3d& origin, const Vec3d& axis)
{
  const Vec3d d = glm::normalize(axis);
  const Vec3d helper = std::abs(d.x) < 0.9 ? Vec3d(1.0, 0.0, 0.0) : Vec3d(0.0, 1.0, 0.0);
  const Vec3d lateral = glm::normalize(helper - glm::dot(helper, d) * d);
  return { origin, d, lateral, glm::cross(d, lateral) };
}

} // namespace sono::test
