#pragma once

#include <string>
#include <vector>

namespace sono {

/// Path of a file of the bundled data ("tissues.csv"), looked up as share/sonovdb/<name> in the folders above this
/// library, so that the build tree, the installed tree and a moved one all work. Throws Error naming the file.
std::string dataFile(const std::string& name);

/// The bundled files of a folder ("probes") with this extension (".json"), sorted, without folder and extension. Throws
/// Error naming the folder.
std::vector<std::string> dataFiles(const std::string& folder, const std::string& extension);

/// The bundled file of a folder that a panel calls `label`: "S-Shaped" is s_shaped.csv. Empty where there is none.
std::string dataFileCalled(const std::string& label, const std::string& folder, const std::string& extension);

/// `chosen`, or where it is empty the bundled file.
std::string chosenOrBundled(const std::string& chosen, const std::string& bundledName);

} // namespace sono
