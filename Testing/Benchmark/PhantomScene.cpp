#include "PhantomScene.h"

#include "Core/Progress.h"
#include "Folders.h"
#include "Labels/AssignTissues.h"

#include <string>
#include <utility>

namespace sono {

std::unique_ptr<Scene> makePhantomScene(LabelVolume volume)
{
  const std::string data = dataFolder();
  const TissueTable table = TissueTable::read(data + "/tissues.csv");
  const LabelTissueMap map = LabelTissueMap::read(data + "/label_tissues.csv");
  const auto unmatched = assignTissues(volume, map, table, "air");
  if (!unmatched.empty())
  {
    throw Error("Label " + unmatched.front() + " of the phantom matches no row of " + data + "/label_tissues.csv.");
  }
  return std::make_unique<Scene>(std::move(volume), table, "air");
}

} // namespace sono
