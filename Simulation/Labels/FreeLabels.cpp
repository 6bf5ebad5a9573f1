#include "Labels/FreeLabels.h"

#include "Core/Progress.h"

#include <algorithm>

namespace sono {

std::vector<int> freeLabelIds(const LabelVolume& volume, int count)
{
  int highest = 0;
  for (const LabelInfo& label : volume.labels)
  {
    highest = std::max(highest, label.id);
  }
  std::vector<int> ids;
  for (int id = highest + 1; id <= 65535 && int(ids.size()) < count; ++id)
  {
    ids.push_back(id);
  }
  for (int id = 1; id <= highest && int(ids.size()) < count; ++id)
  {
    if (!volume.find(id))
    {
      ids.push_back(id);
    }
  }
  if (int(ids.size()) < count)
  {
    throw Error("body fill: the label map uses all ids; merge some labels.");
  }
  return ids;
}

void addLabel(LabelVolume& volume, int id, const std::string& name, const std::array<float, 3>& color)
{
  LabelInfo label;
  label.id = id;
  label.name = name;
  label.color = color;
  label.hasColor = true;
  volume.labels.push_back(std::move(label));
}

} // namespace sono
