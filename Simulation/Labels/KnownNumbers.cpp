#include "Labels/KnownNumbers.h"

#include <algorithm>
#include <iterator>
#include <string>

namespace sono {

namespace {

struct KnownNumber
{
  int id;
  const char* name;
};

/// Zhuang and Shen 2016, Med Image Anal 31:77: the challenge's label values.
constexpr KnownNumber wholeHeart[] = {
  { 205, "left ventricle myocardium" }, { 420, "left atrium blood" },  { 421, "left atrium blood" },
  { 500, "left ventricle blood" },      { 550, "right atrium blood" }, { 600, "right ventricle blood" },
  { 820, "ascending aorta" },           { 850, "pulmonary artery" },
};

const KnownNumber* knownNumber(int id)
{
  const auto* found = std::find_if(std::begin(wholeHeart), std::end(wholeHeart),
                                   [id](const KnownNumber& known) { return known.id == id; });
  return found == std::end(wholeHeart) ? nullptr : found;
}

} // namespace

void nameKnownNumbers(LabelVolume& volume)
{
  const bool allKnown = std::all_of(volume.labels.begin(), volume.labels.end(), [](const LabelInfo& label) {
    const bool isNamed = !label.name.empty() && label.name != "label_" + std::to_string(label.id);
    return label.id == 0 || (!isNamed && knownNumber(label.id));
  });
  const auto count =
    std::count_if(volume.labels.begin(), volume.labels.end(), [](const LabelInfo& label) { return label.id != 0; });
  if (!allKnown || count < 3)
  {
    return;
  }
  for (LabelInfo& label : volume.labels)
  {
    label.name = label.id == 0 ? label.name : knownNumber(label.id)->name;
  }
}

} // namespace sono
