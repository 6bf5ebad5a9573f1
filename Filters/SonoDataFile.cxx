#include "SonoDataFile.h"

#include "Core/Progress.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <dlfcn.h>
#include <filesystem>

namespace sono {

std::string dataFile(const std::string& name)
{
  namespace fs = std::filesystem;
  Dl_info library{};
  std::error_code ignored;
  if (dladdr(reinterpret_cast<const void*>(&dataFile), &library) && library.dli_fname)
  {
    const fs::path self = fs::canonical(library.dli_fname, ignored);
    for (fs::path folder = self.parent_path(); folder.has_relative_path(); folder = folder.parent_path())
    {
      const fs::path candidate = folder / "share" / "sonovdb" / name;
      if (fs::exists(candidate, ignored))
      {
        return candidate.string();
      }
    }
  }
  throw Error("The bundled file share/sonovdb/" + name +
              " is not installed above the SonoVDB library; install SonoVDB again or name a file of your own.");
}

std::vector<std::string> dataFiles(const std::string& folder, const std::string& extension)
{
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(dataFile(folder)))
  {
    if (entry.path().extension() == extension)
    {
      names.push_back(entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string dataFileCalled(const std::string& label, const std::string& folder, const std::string& extension)
{
  std::string file = vtksys::SystemTools::LowerCase(label);
  std::replace_if(
    file.begin(), file.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
  const std::vector<std::string> names = dataFiles(folder, extension);
  const bool isKnown = std::find(names.begin(), names.end(), file) != names.end();
  return isKnown ? dataFile(folder + "/" + file + extension) : std::string();
}

std::string chosenOrBundled(const std::string& chosen, const std::string& bundledName)
{
  return chosen.empty() ? dataFile(bundledName) : chosen;
}

} // namespace sono
