#include "Study.h"

#include "Core/Progress.h"
#include "Labels/CsvFile.h"

#include <cstdio>
#include <fstream>

namespace sono::study {

std::map<std::string, Part::Run>& Part::all()
{
  static std::map<std::string, Run> parts;
  return parts;
}

Output::Output(std::filesystem::path folder, const std::string& part, bool quick)
  : folder_(std::move(folder))
  , part_(part)
  , quick_(quick)
{
  std::filesystem::create_directories(folder_);
}

void Output::figure(const std::string& name, double value, const std::string& unit)
{
  std::printf("%s %.6g %s\n", name.c_str(), value, unit.c_str());
  std::fflush(stdout);
  figures_.push_back({ name, number(value), unit });
}

void Output::table(const std::string& fileName, const std::vector<std::string>& header,
                   const std::vector<std::vector<std::string>>& rows) const
{
  std::ofstream stream(file(fileName));
  const auto line = [&](const std::vector<std::string>& fields) {
    for (std::size_t i = 0; i < fields.size(); ++i)
    {
      stream << (i == 0 ? "" : ",") << csvField(fields[i]);
    }
    stream << '\n';
  };
  line(header);
  for (const auto& row : rows)
  {
    line(row);
  }
  stream.flush();
  if (!stream)
  {
    throw Error("'" + file(fileName).string() + "' cannot be written: choose a folder that you may write to");
  }
}

void Output::finish() const
{
  table("figures_" + part_ + ".csv", { "name", "value", "unit" }, figures_);
}

std::string number(double value)
{
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

} // namespace sono::study
