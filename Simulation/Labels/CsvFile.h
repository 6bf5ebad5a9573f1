#pragma once

#include <optional>
#include <string>
#include <vector>

namespace sono {

/// A table with a header line, separated by commas (in a file that ends in .tsv by tabs). Empty lines and lines
/// starting with '#' are skipped, spaces around a field are dropped, missing last fields are empty. Between commas,
/// fields may be quoted ("" inside quotes is one quote).
struct CsvFile
{
  struct Row
  {
    int line = 0;                    ///< line number in the file, from 1
    std::vector<std::string> fields; ///< as many as the header has
  };

  std::string path; ///< or the text's name
  std::vector<std::string> header;
  std::vector<Row> rows;

  /// Throws Error naming the file (and line) when it is missing, empty, or a line has a broken quote or more fields
  /// than the header.
  static CsvFile read(const std::string& path);
  /// The same of a text, whose name stands for the file's in messages.
  static CsvFile parse(const std::string& text, const std::string& name);

  /// Index of a column; -1 when the header lacks it.
  int column(const std::string& name) const;
  /// Index of a column; throws Error naming file and column when the header lacks it.
  int requiredColumn(const std::string& name) const;
  /// "'table.csv' line 7", for messages.
  std::string where(const Row& row) const;
};

/// The whole text as a number, in any locale; empty when it is not one.
std::optional<double> parseNumber(const std::string& text);

/// The field as it goes into a file: quoted where it must be.
std::string csvField(const std::string& text);

} // namespace sono
