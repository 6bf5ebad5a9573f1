#include "Report.h"
#include "Study.h"
#include "SvgPlot.h"

#include "ErrorText.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

namespace {

using namespace sono::study;

std::filesystem::path emptyFolder(const std::string& name)
{
  const auto folder = std::filesystem::path(testing::TempDir()) / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

std::string textOf(const std::filesystem::path& path)
{
  std::ifstream stream(path);
  return { std::istreambuf_iterator<char>(stream), {} };
}

TEST(StudyReport, HoldsTheFiguresOfAPart)
{
  const auto folder = emptyFolder("study_report");
  Output output(folder, "sample", true);
  output.figure("some_name", 12.5, "mm");
  output.finish();
  writeReport(folder);
  const std::string html = textOf(folder / "report.html");
  EXPECT_NE(html.find("some_name"), std::string::npos);
  EXPECT_NE(html.find("12.5"), std::string::npos);
}

TEST(StudyReport, DrawsErrorsOverPathsAndSecondsAndSaysWhatIsMissing)
{
  const auto folder = emptyFolder("study_errors");
  const Output output(folder, "sample", true);
  output.table("error_stack.csv", { "sampler", "paths", "seconds", "rmse_intensity" },
               { { "independent", "10", "0.1", "0.3" },
                 { "independent", "1000", "10", "0.03" },
                 { "sobol", "10", "0.1", "0.2" } });
  output.table("stability.csv", { "case", "result", "a", "b", "c" },
               { { "depth 0", "refused <clearly>", "0.000123456", "1234567", "12.3456 +- 1" } });
  writeReport(folder);
  const std::string html = textOf(folder / "report.html");
  sono::testing::expectContains(html, "Intensity: error over paths");
  sono::testing::expectContains(html, "Intensity: error over seconds");
  sono::testing::expectContains(html, ">sobol<");
  sono::testing::expectContains(html, "refused &lt;clearly&gt;");
  sono::testing::expectContains(html, "<td>0.0001235</td><td>1234567</td><td>12.3456 +- 1</td>");
  sono::testing::expectContains(html, "skipping.csv is missing");
}

TEST(StudyReport, FiguresThatMissAreNamed)
{
  const auto folder = emptyFolder("study_goals");
  Output output(folder, "sample", true);
  output.figure("tre_mean_mm", 0.2, "mm");
  output.figure("speckle_snr", 1.912, "1");
  output.finish();
  writeReport(folder);
  const std::string html = textOf(folder / "report.html");
  sono::testing::expectContains(html, "MISSED");
  sono::testing::expectContains(html, "<td>met</td>");
}

TEST(SvgPlot, PlacesPointsAndLeavesOutWhatItCannotShow)
{
  const std::string svg = svgPlot("t", { "x", true }, { "y" },
                                  { { "c", { 1.0, 10.0, 100.0, -1.0 }, { 0.0, 1.0, 2.0, 3.0 }, CurveKind::Dots } });
  std::size_t dots = 0;
  for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1))
  {
    ++dots;
  }
  EXPECT_EQ(dots, 4u); // one in the legend
  // The middle one lies halfway between the others on a logarithmic axis.
  const auto placeOf = [&](std::size_t index) {
    std::size_t at = svg.find("cx='");
    for (std::size_t i = 0; i < index; ++i)
    {
      at = svg.find("cx='", at + 1);
    }
    return std::stod(svg.substr(at + 4));
  };
  EXPECT_NEAR(placeOf(1), 0.5 * (placeOf(0) + placeOf(2)), 0.1);
}

TEST(SvgPlot, NoTwoCurvesLookAlike)
{
  // All in one place: what is drawn there differs by its look alone.
  const Curve curve{ "c", { 1.0, 2.0 }, { 1.0, 2.0 }, CurveKind::Line };
  const std::string svg = svgPlot("t", { "x" }, { "y" }, std::vector<Curve>(64, curve));
  std::set<std::string> looks;
  for (std::size_t at = svg.find("<polyline"); at != std::string::npos;)
  {
    const std::size_t legend = svg.find("<polyline", at + 1);
    looks.insert(svg.substr(at, legend - at));
    at = svg.find("<polyline", legend + 1);
  }
  EXPECT_EQ(looks.size(), 64u);
}

TEST(StudyReport, ShowsTheReferencesOwnErrorAndTheGpusCurves)
{
  const auto folder = emptyFolder("study_gpu");
  const Output output(folder, "sample", true);
  const std::vector<std::string> header{ "sampler", "precision", "device", "paths", "seconds", "rmse_rf" };
  output.table("error_rib.csv", header,
               { { "reference", "", "", "1", "", "0.001" },
                 { "independent", "single", "CPU, 2 threads", "1", "0.1", "0.3" },
                 { "independent", "single", "CPU, 2 threads", "10", "1", "0.1" } });
  output.table("error_rib_gpu.csv", header, { { "independent", "single", "GPU", "1", "0.001", "0.3" } });
  writeReport(folder);
  const std::string html = textOf(folder / "report.html");
  sono::testing::expectContains(html, "the reference's own error");
  sono::testing::expectContains(html, "independent, single, GPU");
  EXPECT_EQ(html.find("<h3>rib_gpu</h3>"), std::string::npos);
}

TEST(StudyReport, PlotsPeersAndGrowthAndNamesWhatIsNotInstalled)
{
  const auto folder = emptyFolder("study_peers");
  const Output output(folder, "sample", true);
  const std::vector<std::string> header{ "scene",        "program",       "version", "setting", "seconds",
                                         "core seconds", "first call, s", "error",   "device" };
  output.table("peers.csv", header,
               { { "plane", "SonoVDB", "1", "as it is", "0.1", "0.2", "0.1", "0.001", "CPU" },
                 { "plane", "Other", "2", "fast", "1", "1", "1", "0.01", "CPU" },
                 { "plane", "Other", "2", "exact", "3", "3", "3", "0.0005", "CPU" },
                 { "array", "Third", "4", "fast", "1", "1", "1", "0.01", "CPU" },
                 { "plane", "SonoVDB", "1", "as it is", "0.01", "0.02", "0.1", "0.001", "GPU, a name" },
                 { "plane", "Absent", "", "not installed", "", "", "", "", "" } });
  output.table(
    "growth.csv",
    { "axis", "value", "scene, s", "first picture, s", "first, core s", "next picture, s", "next, core s", "peak, MB" },
    { { "labels", "10", "1", "1", "1", "1", "1", "100" },
      { "labels", "20", "1", "1", "1", "2", "2", "110" },
      { "GPUs", "1", "not measured: no GPU was here", "", "", "", "", "" } });
  writeReport(folder);
  const std::string html = textOf(folder / "report.html");
  sono::testing::expectContains(html, "Scene 'plane': error over core seconds");
  sono::testing::expectContains(html, "Scene 'plane' on a GPU: error over time");
  EXPECT_EQ(html.find("Scene 'array' on a GPU"), std::string::npos);
  sono::testing::expectContains(html, ">Other 2<");
  sono::testing::expectContains(html, "not installed");
  sono::testing::expectContains(html, "Time over labels");
  EXPECT_EQ(html.find("Time over GPUs"), std::string::npos);
  sono::testing::expectContains(html, "no GPU was here");
}

TEST(StudyReport, OfAnEmptyFolderIsRefused)
{
  const auto folder = emptyFolder("study_empty");
  sono::testing::expectContains(sono::testing::errorOf([&] { writeReport(folder); }), "study_empty");
}

} // namespace
