#include "Trace/CollisionLimit.h"

#include "Trace/RecordPaths.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr int pathsAsked = 512;
constexpr double mostCutOff = 0.1; // of the intensity

} // namespace

std::string collisionLimitWarning(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                                  const std::vector<TargetSurface>& targets)
{
  if (!settings.reverberates())
  {
    return {};
  }
  double cutOff = 0.0;
  for (const RecordedPath& path : recordPaths(scene, lines, settings, pathsAsked, targets))
  {
    cutOff += double(path.cutOff);
  }
  const double followed =
    std::min(double(pathsAsked), double(lines.size()) * (settings.deterministic ? 1.0 : settings.pathsPerLine));
  const double share = cutOff / followed;
  if (share <= mostCutOff)
  {
    return {};
  }
  return "Max Collisions is " + std::to_string(settings.maxCollisions) + ", and the paths that it ends still carry " +
         std::to_string(std::lround(100.0 * share)) +
         " % of the sound: multiple echoes that would come later are missing; raise it, or lower Face Reflection.";
}

} // namespace sono
