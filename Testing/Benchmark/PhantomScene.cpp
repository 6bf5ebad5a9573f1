#include "PhantomScene.h"

#include "Core/Progress.h"
#include "Labels/AssignTissues.h"

#include <cstdlib>
#include <string>
#include <utility>

namespace sono {

std::unique_ptr<Scene> makePhantomScene(LabelVolume volume)
{
  // The variable is for programs that are carried to another machine.
  const char* carried = std::getenv("SONOVDB_DATA_DIR");
  const std::string data = carried ? carried : SONOVDB_DATA_DIR;
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
