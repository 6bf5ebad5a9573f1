#pragma once

#include <filesystem>

namespace sono::study {

/// Writes report.html, which holds its pictures, into the folder from the CSV tables and PNG pictures that the parts of
/// the study left there; what a part has not left is named as missing. Besides the phantom's tables it shows
///
/// - error_*.csv: run time against error of a scene (the name after error_), and error_*_gpu.csv, the same from a
///   machine with a GPU. Columns `paths` and `seconds` and any number of errors, named rmse_*; the other columns
///   (sampler, precision, device, ...) name the curve of a row. Each error is drawn against paths and against seconds
///   on logarithmic axes, one curve for each set of names; that of `reference` as a level.
/// - convergence.csv and convergence_gpu.csv, as they are.
/// - stability.csv and skipping.csv, as they are.
///
/// Throws Error when the folder holds no table or the report cannot be written.
void writeReport(const std::filesystem::path& folder);

} // namespace sono::study
