#pragma once

#include <string>

/// Where tests, benchmarks and the study find their files. Functions of a library of their own, as a definition on the
/// command line of each source would keep a compiler's cache from serving another clone.
namespace sono {

/// The repository's Data folder, without a slash at its end; or the folder that the variable SONOVDB_DATA_DIR names,
/// for programs that are carried to another machine.
std::string dataFolder();

/// A file of it, by its name there.
std::string dataFile(const std::string& name);

/// The folder of real segmentations beside the clone, which may not be there.
std::string sharedDataFolder();

/// The table of names that data sets give their labels.
std::string labelNamesFile();

} // namespace sono
