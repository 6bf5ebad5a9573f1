#include "Probe/ProbeOnSkin.h"

#include <algorithm>
#include <cmath>

namespace sono {
namespace {

constexpr double softDbPerCmMHz = 0.5;
constexpr double deeper = 1.3; // than a preset says, by its depth knob
constexpr double contactMm = 6.0;
constexpr double handleMm = 70.0;
constexpr double handleRadiusMm = 10.0;

} // namespace

ProbeOnSkin::ProbeOnSkin(const WindowGrid& grid, const ProbeSettings& probe)
  : grid_(grid)
  , geometry_(probe.geometry)
{
  geometry_.kind = geometry_.isVolume() ? ScanKind::PhasedSector : geometry_.kind;
  geometry_.lineCount = lineCount;
  geometry_.depthMm *= deeper;
  const double edgeMm = std::abs(planeFromBeam(geometry_, lineCount - 1.0, 0.0).x);
  halfFaceMm_ = std::max(edgeMm, 0.5 * probe.apertureMm);
  lookUpLosses(probe.centreFrequencyMHz);
}

std::vector<double> ProbeOnSkin::stepAreas(const std::vector<ScanLine>& lines) const
{
  const double stepMm = grid_.stepMm();
  const ScanLine& a = lines[lineCount / 2];
  const ScanLine& b = lines[lineCount / 2 + 1];
  std::vector<double> areas(std::size_t(geometry_.depthMm / stepMm) + 1);
  for (std::size_t bin = 0; bin < areas.size(); ++bin)
  {
    const double r = (double(bin) + 0.5) * stepMm;
    areas[bin] = stepMm * glm::distance(a.originMm + r * a.axis, b.originMm + r * b.axis);
  }
  return areas;
}

std::pair<int, int> ProbeOnSkin::stepsInside(const Vec3d& from, const Vec3d& axis, double lengthMm) const
{
  const double stepMm = grid_.stepMm();
  const auto isInside = [&](int n) { return grid_.isInside(from + (n + 0.5) * stepMm * axis); };
  const Vec2d range = grid_.rangeWithin(from, axis, Vec3d(0.0), grid_.boxMm());
  const int count = int(std::ceil(lengthMm / stepMm - 0.5));
  int first = std::clamp(int(std::floor(range.x / stepMm)) - 1, 0, count);
  int end = std::clamp(int(std::ceil(range.y / stepMm)) + 1, first, count);
  while (first < end && !isInside(first))
  {
    ++first;
  }
  while (end > first && !isInside(end - 1))
  {
    --end;
  }
  return { first, end };
}

void ProbeOnSkin::lookUpLosses(double frequencyMHz)
{
  const auto& tissues = grid_.scene().tissues();
  for (const Tissue& here : tissues)
  {
    lossOfStep_.push_back(here.attenuationDbPerCmMHz * frequencyMHz * grid_.stepMm() / 10.0);
    for (const Tissue& before : tissues)
    {
      const double sum = here.impedanceMRayl + before.impedanceMRayl;
      lossOfBoundary_.push_back(-10.0 * std::log10(4.0 * here.impedanceMRayl * before.impedanceMRayl / (sum * sum)));
    }
  }
  softLossOfMm_ = softDbPerCmMHz * frequencyMHz / 10.0;
}

bool ProbeOnSkin::hasRoom(const Vec3d& place, const Vec3d& axis) const
{
  const Vec3d helper = std::abs(axis.x) < 0.9 ? Vec3d(1.0, 0.0, 0.0) : Vec3d(0.0, 1.0, 0.0);
  const Vec3d across = handleRadiusMm * glm::normalize(glm::cross(axis, helper));
  const Vec3d over = glm::cross(axis, across);
  for (const Vec3d& offset : { Vec3d(0.0), across, -across, over, -over })
  {
    if (!grid_.isOpen(place + offset, -axis))
    {
      return false;
    }
  }
  for (double behindMm = 20.0; behindMm <= handleMm; behindMm += 10.0)
  {
    for (const Vec3d& offset : { across, -across, over, -over })
    {
      const Vec3d at = place - behindMm * axis + offset;
      if (grid_.isInside(at) && !grid_.isOuter(grid_.at(at)))
      {
        return false;
      }
    }
  }
  return true;
}

bool ProbeOnSkin::touches(const Vec3d& place, const Vec3d& axis, const Vec3d& lateral) const
{
  const Vec3d elevation = glm::cross(axis, lateral);
  int touching = 0;
  const auto check = [&](const Vec3d& face) {
    for (double r = -contactMm; r <= contactMm; r += grid_.stepMm())
    {
      const Vec3d at = face + r * axis;
      if (!grid_.isInside(at))
      {
        return;
      }
      const bool isBody = !grid_.isOuter(grid_.at(at));
      if (isBody)
      {
        const bool isTooDeep = r <= -contactMm; // the face would be pressed in
        touching += !isTooDeep && grid_.isCovered(at, -axis) ? 1 : 0;
        return;
      }
    }
  };
  for (int i = -2; i <= 2; ++i)
  {
    const double share = 0.5 * i;
    const Vec2f edge = planeFromBeam(geometry_, 0.5 * (1.0 + share) * (lineCount - 1), 0.0);
    check(place + double(edge.y) * axis + share * halfFaceMm_ * lateral);
  }
  check(place + 0.7 * contactMm * elevation);
  check(place - 0.7 * contactMm * elevation);
  return touching >= 5;
}

} // namespace sono
