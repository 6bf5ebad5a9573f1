// A data set: 1000 images of the bundled apical preset with masks to disk, all cores; its plan, memory and PNG files.
#include "DataSets/WriteDataSet.h"
#include "Folders.h"
#include "Image/PngFile.h"
#include "Stage.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

namespace sono {
namespace {

void measurePlan(DataSet set)
{
  set.exams = 100000;
  set.imagesPerExam = 10;
  const DataSetPlan plan(std::move(set));
  Stopwatch watch;
  std::size_t letters = 0;
  for (std::int64_t n = 0; n < plan.imageCount(); ++n)
  {
    letters +=
      plan.caseName(n).size() + plan.image(n).parameters.size() + std::size_t(plan.jitter(n, 0).tiltDeg > 90.0);
  }
  printFigure("dataset_plan_s", letters > 0 ? watch.lap() : 0.0, "s", "at most 1, of 10^6 images");
}

void measurePng(const DataSet& set)
{
  const int side = int(160.0 / set.pixelMm);
  std::vector<std::uint8_t> grey(std::size_t(side) * std::size_t(side));
  for (std::size_t i = 0; i < grey.size(); ++i)
  {
    grey[i] = std::uint8_t(drawSeed(1, DrawScope::Image, std::int64_t(i), 0) % 97);
  }
  Stopwatch watch;
  constexpr int repeats = 50;
  std::size_t bytes = 0;
  for (int i = 0; i < repeats; ++i)
  {
    bytes += pngBytes(grey.data(), side, side, set.pixelMm).size();
  }
  printFigure("dataset_png_ms", 1e3 * watch.lap() / repeats, "ms");
  printFigure("dataset_png_share", double(bytes) / double(repeats * grey.size()), "1");
}

void measureDataSet()
{
  DataSet set = readDataSet(dataFile("datasets/apical.json"), dataFolder());
  measurePlan(set);
  measurePng(set);
  set.exams = 100;
  set.patients[0].copies = 10; // 100 images each, as the preset has
  std::string folder = (std::filesystem::temp_directory_path() / "dataset-XXXXXX").string();
  if (!mkdtemp(folder.data()))
  {
    throw Error("cannot make a folder for temporary files.");
  }
  double warm = 0.0;
  Stopwatch watch;
  DataSetImager imager(std::make_shared<const DataSetPlan>(set));
  const DataSetTally tally = writeDataSet(imager, folder, {}, {}, [&](const DataSetTally& now) {
    if (now.made == 1)
    {
      printFigure("dataset_first_image_s", watch.lap(), "s");
    }
    if (now.made == 200)
    {
      warm = residentMegabytes();
    }
  });
  printFigure("dataset_images_per_s", double(tally.made) / tally.seconds, "1/s", "at least 3");
  printFigure("dataset_growth_mb", residentMegabytes() - warm, "MB", "none, over the last 800 of 1000 images");
  printFigure("dataset_peak_mb", peakMegabytes(), "MB");
  std::filesystem::remove_all(folder);
}

const Stage stage("dataset", measureDataSet);

} // namespace
} // namespace sono
