#include "DataSets/MaskGroups.h"

#include "DataSets/MitralLine.h"
#include "Labels/AssignTissues.h"

#include <algorithm>

namespace sono {

namespace {

/// The mask's value of the group of a name.
std::uint8_t valueOf(const std::vector<MaskGroup>& masks, const std::string& name)
{
  const auto group = std::find_if(masks.begin(), masks.end(), [&](const MaskGroup& each) { return each.name == name; });
  return std::uint8_t(group - masks.begin() + 1);
}

} // namespace

std::vector<std::uint8_t> groupsOf(const std::vector<LabelInfo>& labels, const std::vector<MaskGroup>& masks)
{
  LabelTissueMap patterns; // whose "tissues" are the groups
  for (std::size_t group = 0; group < masks.size(); ++group)
  {
    for (const std::string& pattern : masks[group].labels)
    {
      patterns.add({ pattern, std::to_string(group + 1) });
    }
  }
  std::vector<std::uint8_t> values(65536, 0);
  for (const LabelInfo& label : labels)
  {
    if (const LabelTissueRule* rule = patterns.matchName(label.name))
    {
      values[std::size_t(label.id)] = std::uint8_t(std::stoi(rule->tissue));
    }
  }
  return values;
}

std::vector<bool> labelsOf(const std::vector<LabelInfo>& labels, const std::vector<std::string>& patterns)
{
  const std::vector<std::uint8_t> values = groupsOf(labels, { MaskGroup{ {}, patterns } });
  return { values.begin(), values.end() };
}

void divideAtAnnulus(const DataSet& set, const std::vector<bool>& isValve, const std::vector<ImageLandmark>& landmarks,
                     const std::uint16_t* labels, int width, std::vector<std::uint8_t>& mask)
{
  const auto named = [&](const char* name) {
    return std::find_if(landmarks.begin(), landmarks.end(), [&](const ImageLandmark& l) { return l.name == name; });
  };
  const auto annulus = named("mitralAnnulus");
  const auto apex = named("apex");
  if (annulus != landmarks.end() && annulus->hinges.size() == 2 && apex != landmarks.end())
  {
    divideAtHinges(
      annulus->hinges[0], annulus->hinges[1], apex->point,
      { valueOf(set.masks, set.mitralLine->ventricle), valueOf(set.masks, set.mitralLine->atrium), &isValve }, labels,
      width, mask);
  }
}

} // namespace sono
