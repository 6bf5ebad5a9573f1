#include "Html.h"

#include "Core/Progress.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>

namespace sono::study {

namespace {

std::string base64(const std::string& bytes)
{
  static const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3)
  {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
    {
      word = (word << 8) | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k)
    {
      text += i + k <= bytes.size() ? digits[(word >> (18 - 6 * k)) & 63u] : '=';
    }
  }
  return text;
}

/// A table's field as the page shows it: a number with a fraction to four digits, so that a table is no wider than the
/// page where that can be.
std::string shown(const std::string& field)
{
  char* end = nullptr;
  const double value = std::strtod(field.c_str(), &end);
  if (field.find('.') == std::string::npos || *end != '\0')
  {
    return field;
  }
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

} // namespace

std::string escapedHtml(const std::string& text)
{
  std::string out;
  for (const char c : text)
  {
    out += c == '&'   ? std::string("&amp;")
           : c == '<' ? std::string("&lt;")
           : c == '>' ? std::string("&gt;")
                      : std::string(1, c);
  }
  return out;
}

std::string htmlParagraph(const std::string& words)
{
  return "<p>" + escapedHtml(words) + "</p>\n";
}

std::string htmlTable(const CsvFile& csv, const std::string& command)
{
  std::ostringstream text;
  text << "<div class='wide'><table><caption>" << escapedHtml(std::filesystem::path(csv.path).filename().string())
       << ", by <code>" << escapedHtml(command) << "</code></caption><tr>";
  for (const std::string& name : csv.header)
  {
    text << "<th>" << escapedHtml(name) << "</th>";
  }
  text << "</tr>\n";
  for (const CsvFile::Row& row : csv.rows)
  {
    text << "<tr>";
    for (const std::string& field : row.fields)
    {
      text << "<td>" << escapedHtml(shown(field)) << "</td>";
    }
    text << "</tr>\n";
  }
  text << "</table></div>\n";
  return text.str();
}

std::string htmlPicture(const std::filesystem::path& png, const std::string& words)
{
  std::ifstream stream(png, std::ios::binary);
  const std::string bytes{ std::istreambuf_iterator<char>(stream), {} };
  if (bytes.empty())
  {
    throw Error("'" + png.string() + "' cannot be read: run the part phantom_figures of the study again");
  }
  const std::string name = png.filename().string();
  return "<p><img src='data:image/png;base64," + base64(bytes) + "' alt='" + name + "'><br>" + escapedHtml(words) +
         "</p>\n";
}

double numberOf(const std::string& text)
{
  std::istringstream stream(text);
  double value = 0.0;
  return stream >> value ? value : std::numeric_limits<double>::quiet_NaN();
}

} // namespace sono::study
