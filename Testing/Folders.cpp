#include "Folders.h"

#include <cstdlib>

namespace sono {

std::string dataFolder()
{
  const char* carried = std::getenv("SONOVDB_DATA_DIR");
  return carried ? carried : SONOVDB_ROOT "/Data";
}

std::string dataFile(const std::string& name)
{
  return dataFolder() + "/" + name;
}

std::string sharedDataFolder()
{
  return SONOVDB_ROOT "/../shared/data";
}

std::string labelNamesFile()
{
  return SONOVDB_ROOT "/Testing/Simulation/label_names.csv";
}

} // namespace sono
