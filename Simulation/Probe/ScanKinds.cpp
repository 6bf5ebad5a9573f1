#include "Probe/ScanKinds.h"

#include "Core/Error.h"

namespace sono {

const std::vector<ScanKindTraits>& scanKinds()
{
  static const std::vector<ScanKindTraits> all{
    { "linear",
      "Linear",
      "parallel",
      "LINEAR",
      LineOrigin::Aperture,
      true,
      false,
      0.0,
      { "widthMm", "compoundFans", "compoundSpanDeg" } },
    { "phased_sector",
      "Phased Sector",
      "from one point",
      "SECTOR_PHASED",
      LineOrigin::Apex,
      false,
      false,
      180.0,
      { "sectorDeg" } },
    { "curvilinear",
      "Curvilinear",
      "along the radii of a convex face",
      "CURVED LINEAR",
      LineOrigin::ConvexFace,
      true,
      false,
      180.0,
      { "sectorDeg", "radiusMm", "compoundFans", "compoundSpanDeg" } },
    { "matrix",
      "Matrix",
      "from one point over a volume",
      "SECTOR_PHASED",
      LineOrigin::Apex,
      false,
      true,
      180.0,
      { "sectorDeg", "elevationLineCount", "elevationSectorDeg" } },
    { "radial",
      "Radial",
      "along the radii of a catheter",
      "IV_PHASED",
      LineOrigin::Catheter,
      false,
      false,
      360.0,
      { "sectorDeg", "radiusMm" } },
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

const char* scanKindSentence()
{
  static const std::string sentence = [] {
    std::string words = "Layout of the scan lines: ";
    for (const ScanKindTraits& traits : scanKinds())
    {
      const bool isLast = &traits == &scanKinds().back();
      words += (isLast ? std::string("or ") : std::string()) + traits.lines + (isLast ? "." : ", ");
    }
    return words;
  }();
  return sentence.c_str();
}

} // namespace sono
