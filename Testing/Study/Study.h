#pragma once

#include "Folders.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace sono::study {

/// Where a part of the study leaves what it found: figures on the standard output and in figures_<part>.csv, tables and
/// pictures beside them. The report is made from that folder alone.
class Output
{
public:
  /// Makes the folder. `quick` asks a part for a version of a few seconds that touches the same code.
  Output(std::filesystem::path folder, const std::string& part, bool quick);
  /// Writes figures_<part>.csv. Throws Error when the file cannot be written.
  void finish() const;

  bool quick() const { return quick_; }
  std::filesystem::path file(const std::string& name) const { return folder_ / name; }
  /// Prints `name value unit`.
  void figure(const std::string& name, double value, const std::string& unit);
  /// A CSV file of the folder. Throws Error when it cannot be written.
  void table(const std::string& fileName, const std::vector<std::string>& header,
             const std::vector<std::vector<std::string>>& rows) const;

private:
  std::filesystem::path folder_;
  std::string part_;
  bool quick_;
  std::vector<std::vector<std::string>> figures_;
};

/// A number as tables hold it: six significant digits.
std::string number(double value);

/// A part of the study. A file registers one by a `const Part` of that name; main runs the parts asked for.
class Part
{
public:
  using Run = void (*)(Output&);
  Part(const std::string& name, Run run) { all().emplace(name, run); }
  static std::map<std::string, Run>& all();
};

} // namespace sono::study
