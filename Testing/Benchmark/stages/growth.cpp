// Memory over 10^5 images of a data set to disk, tiny ones of 100 drawn bodies (minutes, 2 GB in the temporary folder).
#include "DataSets/WriteDataSet.h"
#include "Folders.h"
#include "Stage.h"

#include <cstdlib>
#include <filesystem>
#include <map>

namespace sono {
namespace {

constexpr std::int64_t images = 100000;

/// The apical preset with pictures that cost next to nothing: what is kept of an image or a body is kept of these, too.
DataSet tinySet()
{
  DataSet set = readDataSet(dataFile("datasets/apical.json"), dataFolder());
  const std::map<std::string, double> tiny{
    { "lineCount", 8 }, { "depthMm", 60 }, { "pathsPerLine", 1 }, { "samplingMHz", 10 }
  };
  for (DrawnParameter& parameter : set.parameters)
  {
    const auto value = tiny.find(parameter.name);
    parameter.draw = value == tiny.end() ? parameter.draw : always(value->second);
  }
  set.patients[0].spacingMm = 4.0;
  set.patients[0].isDrawn = true;
  set.patients[0].copies = 100;
  set.pixelMm = 2.0;
  set.imagesPerExam = 10;
  set.exams = images / set.imagesPerExam;
  return set;
}

void measureGrowth()
{
  std::string folder = (std::filesystem::temp_directory_path() / "growth-XXXXXX").string();
  if (!mkdtemp(folder.data()))
  {
    throw Error("cannot make a folder for temporary files.");
  }
  double warm = 0.0;
  DataSetImager imager(std::make_shared<const DataSetPlan>(tinySet()));
  const DataSetTally tally = writeDataSet(imager, folder, {}, {}, [&](const DataSetTally& now) {
    if (now.made == images / 10)
    {
      warm = residentMegabytes();
      printFigure("dataset_resident_1e4_mb", warm, "MB", "after 10^4 images");
    }
  });
  printFigure("dataset_growth_1e5_mb", residentMegabytes() - warm, "MB", "none, from 10^4 to 10^5 images");
  printFigure("dataset_tiny_images_per_s", double(tally.made) / tally.seconds, "1/s");
  printFigure("dataset_peak_1e5_mb", peakMegabytes(), "MB");
  std::filesystem::remove_all(folder);
}

const Stage stage("growth", measureGrowth);

} // namespace
} // namespace sono
