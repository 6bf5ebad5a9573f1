#include "Report.h"

#include "Core/Progress.h"
#include "Detectability.h"
#include "ErrorReport.h"
#include "Html.h"
#include "PeersReport.h"
#include "SvgPlot.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace sono::study {
namespace {

/// What a figure must reach; empty for those that are only reported.
struct Goal
{
  const char* name;
  const char* asked;
  bool (*met)(double);
};

const std::vector<Goal> goals{
  { "tre_mean_mm", "0.02 or less", [](double v) { return v <= 0.02; } },
  { "tre_std_mm", "0.05 or less", [](double v) { return v <= 0.05; } },
  { "gcnr_mean_abs_error", "0.02 or less", [](double v) { return v <= 0.02; } },
  { "contrast_mean_abs_error_db", "1.5 or less", [](double v) { return v <= 1.5; } },
  { "speckle_snr", "1.91 +- 0.01", [](double v) { return std::fabs(v - 1.91) <= 0.01; } },
  { "rayleigh_sse", "6.5e-6 or less", [](double v) { return v <= 6.5e-6; } },
  { "real_mass_level_error_db", "1.0 or less", [](double v) { return v <= 1.0; } },
  { "real_mass_gcnr_error", "0.05 or less", [](double v) { return v <= 0.05; } },
  { "real_wire_width_error_mm", "0.15 or less", [](double v) { return v <= 0.15; } },
  { "attenuation_slope_db_per_cm", "3.60", [](double v) { return std::fabs(v - 3.6) <= 0.005; } },
  { "equal_rmse_path_ratio", "1 or more", [](double v) { return v >= 1.0; } },
  { "equal_rmse_time_ratio_a4c", "10 or more", [](double v) { return v >= 10.0; } },
  { "equal_rmse_time_ratio_stack", "3 or more", [](double v) { return v >= 3.0; } },
  { "equal_rmse_time_ratio_cyst", "3 or more", [](double v) { return v >= 3.0; } },
  { "equal_rmse_time_ratio_rib", "3 or more", [](double v) { return v >= 3.0; } },
  { "equal_rmse_time_ratio_phantom", "3 or more", [](double v) { return v >= 3.0; } },
};

class Report
{
public:
  explicit Report(const std::filesystem::path& folder)
    : folder_(folder)
  {
  }

  std::string html()
  {
    pictures();
    summary();
    wires();
    lesions();
    speckle();
    beam();
    text_ << errorSection(folder_);
    text_ << peersSection(folder_);
    text_ << growthSection(folder_);
    asTheyAre();
    return text_.str();
  }

private:
  std::optional<CsvFile> table(const std::string& name)
  {
    const auto path = folder_ / name;
    if (!std::filesystem::exists(path))
    {
      paragraph("Not measured: " + name + " is missing.");
      return std::nullopt;
    }
    return CsvFile::read(path.string());
  }

  std::vector<std::filesystem::path> filesLike(const std::string& prefix) const
  {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
    {
      const std::string name = entry.path().filename().string();
      if (name.rfind(prefix, 0) == 0 && entry.path().extension() == ".csv")
      {
        files.push_back(entry.path());
      }
    }
    std::sort(files.begin(), files.end());
    return files;
  }

  void heading(const std::string& words) { text_ << "<h2>" << escapedHtml(words) << "</h2>\n"; }
  void paragraph(const std::string& words) { text_ << htmlParagraph(words); }

  void showTable(const std::string& name, const std::string& part)
  {
    if (const auto csv = table(name))
    {
      text_ << htmlTable(*csv, commandOf(part));
    }
  }

  static std::string commandOf(const std::string& part) { return "Testing/study.sh FOLDER " + part + " report"; }

  /// Columns of a table over its first, one curve each.
  void plotColumns(const CsvFile& csv, const std::string& title, const std::string& unit)
  {
    std::vector<Curve> curves;
    for (std::size_t column = 1; column < csv.header.size(); ++column)
    {
      Curve curve{ csv.header[column], {}, {}, CurveKind::Line };
      for (const CsvFile::Row& row : csv.rows)
      {
        curve.x.push_back(numberOf(row.fields[0]));
        curve.y.push_back(numberOf(row.fields[column]));
      }
      curves.push_back(curve);
    }
    text_ << svgPlot(title, { csv.header[0] }, { unit }, curves);
  }

  void summary()
  {
    heading("Figures");
    text_ << "<table><tr><th>figure</th><th>value</th><th>unit</th><th>asked</th><th></th></tr>\n";
    for (const auto& path : filesLike("figures_"))
    {
      for (const CsvFile::Row& row : CsvFile::read(path.string()).rows)
      {
        const auto goal =
          std::find_if(goals.begin(), goals.end(), [&](const Goal& g) { return row.fields[0] == g.name; });
        const bool asked = goal != goals.end();
        const char* verdict = !asked ? "" : goal->met(numberOf(row.fields[1])) ? "met" : "MISSED";
        text_ << "<tr><td>" << escapedHtml(row.fields[0]) << "</td><td>" << escapedHtml(row.fields[1]) << "</td><td>"
              << escapedHtml(row.fields[2]) << "</td><td>" << (asked ? goal->asked : "") << "</td><td>" << verdict
              << "</td></tr>\n";
      }
    }
    text_ << "</table>\n";
  }

  void wires()
  {
    heading("Wires: target registration error");
    paragraph("Each wire is looked for along the line that should hold it, in the scan-converted image with pixels of "
              "0.23 mm; its place is the vertex of the parabola through the main lobe in dB. The seed's column stands "
              "beside it. The first rows have wires as targets, Embree surfaces that echo as any target does; for "
              "comparison as lines of scatterers, and as voxels.");
    showTable("phantom_tre.csv", "phantom_wires");
    showTable("phantom_wire_models.csv", "phantom_wires");
    if (const auto csv = table("phantom_wires.csv"))
    {
      std::map<std::string, Curve> groups;
      for (const CsvFile::Row& row : csv->rows)
      {
        Curve& curve = groups[row.fields[0]];
        curve.name = row.fields[0];
        curve.kind = CurveKind::Dots;
        curve.x.push_back(numberOf(row.fields[3]));
        curve.y.push_back(numberOf(row.fields[4]));
      }
      std::vector<Curve> curves;
      for (const auto& [name, curve] : groups)
      {
        curves.push_back(curve);
      }
      text_ << svgPlot("Error of each wire", { "depth, mm" }, { "found less true place, mm" }, curves);
      paragraph("Each dot is a wire of the headline row: how far its fitted place lies from the true one, against its "
                "depth. The spread grows with depth, where the beam is wide and speckle pulls at the peak.");
    }
  }

  void lesions()
  {
    heading("Lesions: gCNR, CNR, contrast");
    paragraph("Ten seeds. gCNR, CNR and contrast are of the envelope; the row \"as shown\" is of the grey levels. Two "
              "regions of fully developed speckle have one gCNR for each contrast, the curve below. The seed's real "
              "values lie beside it, so no simulator of such speckle can meet its gCNR and its contrast at once: "
              "gcnr_error_theory_allows is the smallest mean error of gCNR when contrast is off by 1.5 dB on average. "
              "What size and depth the seed's anechoic lesions have it does not tell; the second table shows what both "
              "do to their contrast.");
    if (const auto csv = table("phantom_lesions.csv"))
    {
      text_ << htmlTable(*csv, commandOf("phantom_lesions"));
      plotLesions(*csv);
    }
    showTable("phantom_anechoic.csv", "phantom_anechoic");
    paragraph("Other settings, each the same for all lesions.");
    showTable("phantom_settings.csv", "phantom_settings");
    heading("The phantom under a real linear probe");
    paragraph(
      "H 10 MHz, 40 mm, 60 dB, focus 25 mm, as the screen of a real scanner says; what is real was measured in its "
      "two pictures. Bandwidth, fans and smoothing of the last column were chosen by the speckle of plain gel, and "
      "what is smoothed by the wires, nothing for a single target: a mass has the level that its maker states. With "
      "these levels no speckle of one kind comes nearer to the real gCNR than 0.073 on average (normal levels in dB).");
    showTable("phantom_real.csv", "phantom_real");
    picture("phantom_real.png", "Anechoic cylinders and masses; wires. Above as the beam has it, below smoothed.");
  }

  /// gCNR over the size of the contrast: theory, the seed's real and simulated lesions, and ours.
  void plotLesions(const CsvFile& csv)
  {
    Curve theory{ "speckle in theory", {}, {}, CurveKind::Line };
    for (double db = 0.5; db <= 26.0; db += 0.5)
    {
      theory.x.push_back(db);
      theory.y.push_back(gcnrOfSpeckle(db));
    }
    std::vector<Curve> curves{ theory };
    const std::map<std::string, std::size_t> columns{ { "real (seed)", 2 }, { "simulated (seed)", 3 }, { "here", 4 } };
    for (const auto& [name, column] : columns)
    {
      Curve curve{ name, {}, {}, CurveKind::Dots };
      for (const CsvFile::Row& row : csv.rows)
      {
        if (row.fields[1] == "gCNR")
        {
          curve.y.push_back(numberOf(row.fields[column]));
        }
        if (row.fields[1] == "contrast dB")
        {
          curve.x.push_back(std::fabs(numberOf(row.fields[column])));
        }
      }
      curves.push_back(curve);
    }
    text_ << svgPlot("gCNR and contrast of the five lesions", { "contrast, dB, without sign" }, { "gCNR" }, curves);
    paragraph("The curve is what fully developed speckle must have. Ours lie on it; the seed's real lesions do not.");
  }

  void speckle()
  {
    heading("Speckle");
    paragraph("600 scatterers of amplitude 1 per mm2 in 40 x 40 mm, beam sigma 2 mm. The error of the fit is what the "
              "number of independent samples leaves: ten seeds pooled leave a tenth of one.");
    if (const auto csv = table("phantom_speckle.csv"))
    {
      plotColumns(*csv, "Envelope of the first seed", "share");
    }
  }

  void beam()
  {
    heading("Beam");
    paragraph("Full width at half maximum of a wire's echo. The lateral reference holds for one frequency and a "
              "transmit focus at each depth; here it is at 50 mm, and the band and the wire's length widen the beam "
              "there by a tenth.");
    if (const auto csv = table("phantom_fwhm.csv"))
    {
      plotColumns(*csv, "Width of a wire's echo", "mm");
    }
  }

  void picture(const std::string& name, const std::string& words)
  {
    if (std::filesystem::exists(folder_ / name))
    {
      text_ << htmlPicture(folder_ / name, words + " By " + commandOf("phantom_figures") + ".");
    }
    else
    {
      paragraph("Not drawn: " + name + " is missing.");
    }
  }

  void pictures()
  {
    heading("Pictures");
    picture("phantom.png", "The phantom's three views.");
    picture("artefacts.png", "Enhancement behind a ball of water; shadow of a ball of bone; a rib, labels and image.");
    const std::string panels = "From the upper left: segmentation, without MCPT, 500 rays, 2500 rays; C0 0.2, "
                               "gamma -1.8, tau 2.8, Gaussian beam with sigma 1.5 mm.";
    picture("parameters.png", "Acoustic: rough surfaces that echo. " + panels);
    showTable("phantom_parameters.csv", "phantom_figures");
    picture("parameters_seed.png", "The seed's equations to the letter, lobe 45 degrees. " + panels);
    showTable("phantom_parameters_seed.csv", "phantom_figures");
  }

  void asTheyAre()
  {
    heading("Stability");
    paragraph(
      "Every hazard that Data/docs/physics.md section 8 names, a scene for each: what comes out, what it costs, how "
      "far single "
      "precision lies from double down to the B-mode, beside the standard error of the paths. What single "
      "precision decides otherwise at a hit (along a wall, on an edge) sends a path elsewhere. A computed field "
      "has no twin. The seed tells nothing of its stability.");
    showTable("stability.csv", "stability");
    heading("Skipping");
    paragraph(
      "What time and memory would be with one skip switched off: more than 1 is what it buys, medians of five "
      "pairs by one thread. Tracing with 500 paths a line; RF of eight lines. Bricks that no beam sees, and the "
      "store of all scatterers, are measured once.");
    showTable("skipping.csv", "skipping");
  }

  std::filesystem::path folder_;
  std::ostringstream text_;
};

constexpr const char* head =
  R"(<!DOCTYPE html><html><head><meta charset="utf-8"><title>SonoVDB: the study</title><style>
body { font-family: sans-serif; max-width: 72em; margin: 2em auto; padding: 0 1em; color: #222; }
table { border-collapse: collapse; margin: 1em 0; font-size: 0.9em; }
caption { text-align: left; color: #666; }
td, th { border: 1px solid #ccc; padding: 0.2em 0.6em; text-align: left; }
img, svg { max-width: 100%; }
.wide { overflow-x: auto; }
</style></head><body>
<h1>SonoVDB: the study</h1>
<p>"The seed" is Amadou et al. 2024. Settings and their reasons stand in Testing/Study/PhantomImaging.cpp.
Tables show four digits; the files that they name hold six.</p>
)";

} // namespace

void writeReport(const std::filesystem::path& folder)
{
  std::error_code ignored;
  const bool any = std::filesystem::is_directory(folder, ignored) &&
                   std::any_of(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator(),
                               [](const auto& entry) { return entry.path().extension() == ".csv"; });
  if (!any)
  {
    throw Error("'" + folder.string() + "' holds no tables: run the parts of the study first");
  }
  std::ofstream html(folder / "report.html");
  html << head << Report(folder).html() << "</body></html>\n";
  html.flush();
  if (!html)
  {
    throw Error("'" + (folder / "report.html").string() + "' cannot be written: choose a folder that you may write to");
  }
}

} // namespace sono::study
