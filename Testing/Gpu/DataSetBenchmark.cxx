// DataSetBenchmark FILE [FOLDER [PART PARTS]]: writes a data set through vtkSonoDataSet, on a GPU where there is one,
// or without a folder takes its images one after the other as a loop that learns from them does, and prints what it
// took, one `name value unit` a line.
#include "vtkSonoDataSet.h"

#include "vtkCommand.h"
#include "vtkNew.h"

#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

namespace {

/// Tells the filter's progress, twice a second at most.
class Teller : public vtkCommand
{
public:
  static Teller* New() { return new Teller; }
  void Execute(vtkObject* caller, unsigned long, void*) override
  {
    const auto now = std::chrono::steady_clock::now();
    if (now - told_ > std::chrono::milliseconds(500))
    {
      told_ = now;
      std::fprintf(stderr, "\r%s ", static_cast<vtkAlgorithm*>(caller)->GetProgressText());
    }
  }

private:
  std::chrono::steady_clock::time_point told_;
};

double secondsSince(std::chrono::steady_clock::time_point from)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
}

/// Images that came out of the stream.
int takeAll(vtkSonoDataSet* dataSet)
{
  int taken = 0;
  dataSet->BeginStream("");
  for (int found = dataSet->TakeImage(); found != vtkSonoDataSet::NO_IMAGE_LEFT; found = dataSet->TakeImage())
  {
    if (found == vtkSonoDataSet::IMAGE_AWAITED)
    {
      std::this_thread::sleep_for(std::chrono::microseconds(500));
      continue;
    }
    dataSet->Update();
    ++taken;
  }
  return taken;
}

void printCost(int images)
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const double cpuSeconds = double(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                            1e-6 * double(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
  std::printf("dataset_cpu_ms_per_image %.6g ms\n", 1e3 * cpuSeconds / images);
  std::printf("dataset_peak_mb %.6g MB\n", double(usage.ru_maxrss) / 1e3);
}

} // namespace

int main(int argc, char** argv)
{
  if (argc != 2 && argc != 3 && argc != 5)
  {
    std::fprintf(stderr, "usage: DataSetBenchmark FILE [FOLDER [PART PARTS]]\n");
    return 2;
  }
  vtkNew<vtkSonoDataSet> dataSet;
  vtkNew<Teller> teller;
  dataSet->AddObserver(vtkCommand::ProgressEvent, teller);
  dataSet->SetFileName(argv[1]);
  const auto from = std::chrono::steady_clock::now();
  if (argc == 2)
  {
    const int taken = takeAll(dataSet);
    const double seconds = secondsSince(from);
    std::printf("dataset_taken %d images\n", taken);
    std::printf("dataset_taken_per_s %.6g 1/s\n", double(taken) / seconds);
    printCost(taken);
    return taken > 0 ? 0 : 1;
  }
  dataSet->SetFolder(argv[2]);
  if (argc == 5)
  {
    dataSet->SetPart(std::atoi(argv[3]));
    dataSet->SetParts(std::atoi(argv[4]));
    dataSet->SetImageNumber(int(dataSet->GetFirstImage()));
  }
  dataSet->Update();
  std::fprintf(stderr, "\n");
  const int written = int(dataSet->GetWrittenImages());
  std::printf("dataset_written %d images\n", written);
  std::printf("dataset_images_per_s %.6g 1/s\n", dataSet->GetImagesPerSecond());
  std::printf("dataset_wall_s %.6g s\n", secondsSince(from));
  printCost(written);
  return written > 0 ? 0 : 1;
}
