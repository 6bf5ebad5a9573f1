#pragma once

#include <filesystem>
#include <string>

namespace sono::study {

/// The report's section of programs of others (peers*.csv) and that of growth (growth*.csv): plots, then tables. What
/// is missing is named.
std::string peersSection(const std::filesystem::path& folder);
std::string growthSection(const std::filesystem::path& folder);

} // namespace sono::study
