#include "ErrorReport.h"

#include "Html.h"
#include "SvgPlot.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <vector>

namespace sono::study {
namespace {

const char* const command = "Testing/study.sh FOLDER error report";
const char* const gpuCommand = "Testing/run-gpu.sh study";
const char* const modelsCommand = "Testing/study.sh FOLDER error_models report";

/// A column of errors in a plot's words.
struct Meaning
{
  std::string of;
  std::string unit;
};

Meaning meaningOf(const std::string& column)
{
  static const std::map<std::string, Meaning> meanings{
    { "rmse_intensity", { "Intensity", "root mean square error, share of the rms" } },
    { "rmse_rf", { "RF", "root mean square error, share of the rms" } },
    { "rmse_db", { "B-mode", "root mean square error, dB" } },
  };
  const auto found = meanings.find(column);
  return found == meanings.end() ? Meaning{ column, column } : found->second;
}

/// All columns that neither are measured nor are the axis.
std::string curveOf(const CsvFile& csv, const CsvFile::Row& row)
{
  std::string name;
  for (std::size_t i = 0; i < csv.header.size(); ++i)
  {
    const std::string& column = csv.header[i];
    if (column != "paths" && column != "seconds" && column.rfind("rmse_", 0) != 0 && !row.fields[i].empty())
    {
      name += (name.empty() ? "" : ", ") + row.fields[i];
    }
  }
  return name;
}

bool has(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

/// Curves, then dots, then the reference's own error.
std::vector<Curve> curvesOf(const CsvFile& csv, const std::string& error, const std::string& over)
{
  const auto x = std::size_t(csv.column(over));
  const auto y = std::size_t(csv.column(error));
  std::vector<Curve> curves;
  for (const CsvFile::Row& row : csv.rows)
  {
    const std::string name = curveOf(csv, row);
    auto curve = std::find_if(curves.begin(), curves.end(), [&](const Curve& c) { return c.name == name; });
    if (curve == curves.end())
    {
      curve = curves.insert(curve, Curve{ name, {}, {}, CurveKind::Line });
    }
    // Threads do not change a result: over paths their curves would hide each other.
    if (over == "paths" && has(name, "CPU, 1 thread"))
    {
      continue;
    }
    curve->x.push_back(numberOf(row.fields[x]));
    curve->y.push_back(numberOf(row.fields[y]));
  }
  for (Curve& curve : curves)
  {
    const std::string reference = "reference";
    if (curve.name.rfind(reference, 0) == 0)
    {
      curve.name = "the reference's own error" + curve.name.substr(reference.size());
      curve.kind = CurveKind::Level;
    }
    else if (curve.x.size() == 1) // an error that more paths do not lessen
    {
      curve.kind = CurveKind::Dots;
    }
  }
  return curves;
}

std::string plot(const CsvFile& csv, const std::string& error, const std::string& over)
{
  if (csv.column(over) < 0)
  {
    return "";
  }
  const std::vector<Curve> curves = curvesOf(csv, error, over);
  const bool any = std::any_of(curves.begin(), curves.end(), [](const Curve& curve) {
    return !curve.y.empty() && *std::max_element(curve.y.begin(), curve.y.end()) > 0.0;
  });
  if (!any)
  {
    return htmlParagraph(error + " is 0 throughout: nothing that is chosen by chance lies in the way.");
  }
  const std::string unit = over == "paths" ? "paths of each scan line" : "seconds of tracing, by the wall";
  const Meaning meaning = meaningOf(error);
  return svgPlot(meaning.of + ": error over " + over, { unit, true }, { meaning.unit, true }, curves);
}

/// Scenes by name, each with the GPU's rows behind the CPU's where there are any.
std::map<std::string, CsvFile> scenesIn(const std::filesystem::path& folder)
{
  std::map<std::string, CsvFile> scenes;
  for (const bool gpu : { false, true })
  {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
    {
      const std::string stem = entry.path().stem().string();
      const std::size_t suffix = stem.rfind("_gpu");
      if (stem.rfind("error_", 0) != 0 || entry.path().extension() != ".csv" || (suffix != std::string::npos) != gpu)
      {
        continue;
      }
      const CsvFile csv = CsvFile::read(entry.path().string());
      const auto [scene, first] = scenes.emplace(gpu ? stem.substr(6, suffix - 6) : stem.substr(6), csv);
      for (const CsvFile::Row& row : csv.rows)
      {
        if (!first && row.fields[0] != "reference") // each machine's is as good as the other's
        {
          scene->second.rows.push_back(row);
        }
      }
    }
  }
  return scenes;
}

} // namespace

std::string errorSection(const std::filesystem::path& folder)
{
  std::ostringstream text;
  text << "<h2>Run time against error</h2>\n";
  const auto scenes = scenesIn(folder);
  if (scenes.empty())
  {
    text << htmlParagraph("Not measured: there is no error_*.csv.");
    return text.str();
  }
  text << htmlParagraph(
    "Five scenes, four neighbouring scan lines of each, so that a million paths of every line take seconds. Errors are "
    "root mean squares against a reference: a finite sum for the stack of planar layers, for the others the mean of "
    "eight images of half a million paths each, whose spread tells its own error (dashed; its square is taken "
    "from that of each error). Slopes are of one seed, with the error that the scatter around the line tells. "
    "Intensity and RF are relative to their rms, the envelope's dB are cut off 60 dB below "
    "the maximum. Double precision is a twin for this study alone, kernels compiled again, down to the RF; its time "
    "says nothing. The seed has no such table: it names 1000 rays an element and 300 ms an image.");
  text << htmlParagraph(
    "Dots are errors that more paths do not lessen, at the place of the 4000 paths they were measured with, on "
    "sixteen lines: voxels (with smoothed surfaces, or their bare faces) against voxels of 0.25 mm (a4c: 0.5), as the "
    "root of the mean product of the differences by two seeds, in which nothing of the paths' noise is left, and "
    "radial bins against bins of 0.05 mm with the same paths. A curve that has fallen below a dot is no place to spend "
    "time: the dot is.");
  text << htmlParagraph("What a picture is made of by default, all that reverberates among it, beside the model of "
                        "Amadou et al. 2024 (tables "
                        "and plots *_models): 32 neighbouring lines, root mean squares over three seeds, each model "
                        "against the mean of eight "
                        "images of its own of 50,000 paths a line.");
  for (const auto& [file, by] : { std::pair{ "convergence.csv", command },
                                  { "convergence_gpu.csv", gpuCommand },
                                  { "convergence_models.csv", modelsCommand } })
  {
    if (std::filesystem::exists(folder / file))
    {
      text << htmlTable(CsvFile::read((folder / file).string()), by);
    }
    else
    {
      text << htmlParagraph(
        std::string("Not measured: ") + file + " is missing" +
        (by == gpuCommand ? std::string("; no GPU was here, ") + gpuCommand + " runs it on one." : std::string(".")));
    }
  }
  for (const auto& [name, csv] : scenes)
  {
    text << "<h3>" << escapedHtml(name) << "</h3>\n";
    for (const std::string& error : csv.header)
    {
      if (error.rfind("rmse_", 0) == 0)
      {
        text << plot(csv, error, "paths") << plot(csv, error, "seconds");
      }
    }
    text << "<details><summary>Table</summary>\n" << htmlTable(csv, command) << "</details>\n";
  }
  return text.str();
}

} // namespace sono::study
