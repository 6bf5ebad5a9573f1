#pragma once

#include <string>

namespace sono {

/// Path of a file of the bundled data ("tissues.csv"), looked up as share/sonovdb/<name> in the folders above this
/// library, so that the build tree, the installed tree and a moved one all work. Throws Error naming the file.
std::string dataFile(const std::string& name);

/// `chosen`, or where it is empty the bundled file.
std::string chosenOrBundled(const std::string& chosen, const std::string& bundledName);

} // namespace sono
