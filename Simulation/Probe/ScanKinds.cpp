#include "Probe/ScanKinds.h"

#include "Core/Error.h"

namespace sono {

const std::vector<ScanKindTraits>& scanKinds()
{
  static const std::vector<ScanKindTraits> all{
    { "linear", "Linear", LineOrigin::Aperture, false, 0.0, { "widthMm" } },
    { "phased_sector", "Phased Sector", LineOrigin::Apex, false, 180.0, { "sectorDeg" } },
    { "curvilinear", "Curvilinear", LineOrigin::ConvexFace, false, 180.0, { "sectorDeg", "radiusMm" } },
    { "matrix", "Matrix", LineOrigin::Apex, true, 180.0, { "sectorDeg", "elevationLineCount", "elevationSectorDeg" } },
    { "radial", "Radial", LineOrigin::Catheter, false, 360.0, { "sectorDeg", "radiusMm" } },
  };
  return all;
}

const ScanKindTraits& traitsOf(ScanKind kind)
{
  const auto index = static_cast<std::size_t>(kind);
  if (index >= scanKinds().size())
  {
    std::string names;
    for (const ScanKindTraits& traits : scanKinds())
    {
      names += (names.empty() ? "" : ", ") + std::to_string(&traits - scanKinds().data()) + " (" + traits.label + ")";
    }
    throw Error("scanKind is " + std::to_string(static_cast<int>(kind)) + ": there is no such scan kind; choose " +
                names + ".");
  }
  return scanKinds()[index];
}

std::vector<const char*> scanKindLabels()
{
  std::vector<const char*> labels;
  for (const ScanKindTraits& traits : scanKinds())
  {
    labels.push_back(traits.label);
  }
  return labels;
}

} // namespace sono
