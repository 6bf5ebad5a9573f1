#pragma once

#include "Labels/CsvFile.h"

#include <filesystem>
#include <string>

namespace sono::study {

/// Text as HTML holds it.
std::string escapedHtml(const std::string& text);

std::string htmlParagraph(const std::string& words);

/// A table with its header, its fractions to four digits; it scrolls inside a page that is narrower. `command` tells
/// the reader what measured it.
std::string htmlTable(const CsvFile& csv, const std::string& command);

/// An image element that holds the PNG itself, so that the page is one file. Throws Error when it cannot be read.
std::string htmlPicture(const std::filesystem::path& png, const std::string& words);

/// The number that a table's field begins with ("12.3 +- 4" counts as 12.3), NaN for none.
double numberOf(const std::string& text);

} // namespace sono::study
