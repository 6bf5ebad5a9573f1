#include "Phantoms/CheckThorax.h"

#include "Phantoms/BeatingHeart.h"
#include "Phantoms/ThoraxLabels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <vector>

namespace sono {

namespace {

/// Which labels a chamber's blood may touch. The aorta's wall begins within the ventricle's outflow tract and passes
/// between the atria.
using Touch = std::array<std::array<bool, ThoraxLabelCount>, 4>;

Touch allowedTouch(bool aorticValveIsOpen)
{
  Touch touch{};
  const auto allow = [&touch](ThoraxLabel chamber, std::initializer_list<ThoraxLabel> labels) {
    touch[chamber - LeftVentricleBlood][chamber] = true;
    for (const ThoraxLabel label : labels)
    {
      touch[chamber - LeftVentricleBlood][label] = true;
    }
  };
  allow(LeftVentricleBlood,
        { LeftVentricleMyocardium, InterventricularSeptum, MitralValve, AorticValve, AortaWall, LeftAtriumWall,
          PapillaryMuscleAnterolateral, PapillaryMusclePosteromedial, LeftAtriumBlood });
  allow(RightVentricleBlood, { RightVentricleMyocardium, InterventricularSeptum, LeftVentricleMyocardium,
                               TricuspidValve, RightAtriumWall, PapillaryMuscleRight, RightAtriumBlood, AortaWall });
  allow(LeftAtriumBlood,
        { LeftAtriumWall, InteratrialSeptum, MitralValve, LeftVentricleMyocardium, InterventricularSeptum, AortaWall,
          LeftVentricleBlood, RightAtriumWall, PapillaryMuscleAnterolateral, PapillaryMusclePosteromedial });
  allow(RightAtriumBlood,
        { RightAtriumWall, InteratrialSeptum, TricuspidValve, RightVentricleMyocardium, LeftVentricleMyocardium,
          InterventricularSeptum, AortaWall, RightVentricleBlood, LeftAtriumWall, PapillaryMuscleRight });
  touch[0][AortaLumen] = aorticValveIsOpen;
  return touch;
}

bool isChamber(int id)
{
  return id >= LeftVentricleBlood && id <= RightAtriumBlood;
}

/// Size of the part that holds `start`, whose voxels become Background.
std::size_t takePart(std::vector<std::uint16_t>& voxels, std::size_t start, const std::array<std::ptrdiff_t, 3>& steps)
{
  const std::uint16_t id = voxels[start];
  std::vector<std::size_t> open{ start };
  voxels[start] = Background;
  std::size_t size = 0;
  while (!open.empty())
  {
    const std::size_t here = open.back();
    open.pop_back();
    ++size;
    for (const std::ptrdiff_t step : { steps[0], -steps[0], steps[1], -steps[1], steps[2], -steps[2] })
    {
      const std::size_t next = here + std::size_t(step);
      if (next < voxels.size() && voxels[next] == id)
      {
        voxels[next] = Background;
        open.push_back(next);
      }
    }
  }
  return size;
}

} // namespace

ThoraxFaults checkThorax(const LabelVolume& labels, const ThoraxParameters& parameters)
{
  const Touch touch = allowedTouch(outflowOpeningAt(parameters.phase) > 0.0);
  const Vec3i size = labels.placement.size;
  const std::array<std::ptrdiff_t, 3> steps{ 1, size.x, std::ptrdiff_t(size.x) * size.y };
  ThoraxFaults faults;
  std::array<std::size_t, 4> count{};
  std::array<std::size_t, 4> largest{};
  std::vector<std::uint16_t> left = labels.voxels;
  for (std::size_t here = 0; here < labels.voxels.size(); ++here)
  {
    const int id = labels.voxels[here];
    for (const std::ptrdiff_t step : steps)
    {
      const std::size_t next = here + std::size_t(step);
      const int other = next < labels.voxels.size() ? labels.voxels[next] : int(Background);
      faults.open += isChamber(id) && !touch[id - LeftVentricleBlood][other] ? 1 : 0;
      faults.open += isChamber(other) && !touch[other - LeftVentricleBlood][id] ? 1 : 0;
    }
    if (isChamber(id))
    {
      const int chamber = id - LeftVentricleBlood;
      ++count[chamber];
      if (left[here] == id)
      {
        largest[chamber] = std::max(largest[chamber], takePart(left, here, steps));
      }
    }
  }
  const std::array<double, 4> asked{ parameters.leftVentricleMl, parameters.rightVentricleMl, parameters.leftAtriumMl,
                                     parameters.rightAtriumMl };
  const double contraction = contractionAt(parameters.phase);
  const Vec3d s = labels.placement.spacingMm;
  for (std::size_t chamber = 0; chamber < 4; ++chamber)
  {
    const double volumeMl = double(count[chamber]) * s.x * s.y * s.z / 1000.0;
    faults.apart += double(largest[chamber]) < 0.995 * double(count[chamber]) ? 1 : 0;
    if (contraction == 0.0)
    {
      faults.volumes += std::abs(volumeMl / asked[chamber] - 1.0) > 0.05 ? 1 : 0;
    }
    else if (chamber == 0)
    {
      const double ejectedPercent = 100.0 * (1.0 - volumeMl / asked[chamber]);
      faults.volumes += std::abs(ejectedPercent - contraction * parameters.ejectionPercent) > 10.0 ? 1 : 0;
    }
  }
  return faults;
}

} // namespace sono
