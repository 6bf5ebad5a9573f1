#pragma once

#include <filesystem>
#include <string>

namespace sono::study {

/// The section of the report on run time against error, as HTML, from the tables error_*.csv, convergence.csv and those
/// of the same names with _gpu. See Report.h.
std::string errorSection(const std::filesystem::path& folder);

} // namespace sono::study
