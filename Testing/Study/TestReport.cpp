#include "Report.h"
#include "Study.h"

#include "ErrorText.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

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

TEST(StudyReport, OfAnEmptyFolderIsRefused)
{
  const auto folder = emptyFolder("study_empty");
  sono::testing::expectContains(sono::testing::errorOf([&] { writeReport(folder); }), "study_empty");
}

} // namespace
