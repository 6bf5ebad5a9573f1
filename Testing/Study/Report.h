#pragma once

#include <filesystem>

namespace sono::study {

/// Writes report.html into the folder from the CSV tables and PNG pictures that the parts of the study left there; what
/// a part has not left is named as missing. Besides the phantom's tables it shows
///
/// - error_*.csv: run time against error of a scene (the name after error_). Columns `paths` and `seconds` and any
///   number of errors, named rmse_*; the other columns (sampler, precision, threads, ...) name the curve of a row. Each
///   error is drawn against paths and against seconds on logarithmic axes, one curve for each set of names.
/// - stability.csv and skipping.csv, as they are.
///
/// Throws Error when the folder holds no table or the report cannot be written.
void writeReport(const std::filesystem::path& folder);

} // namespace sono::study
