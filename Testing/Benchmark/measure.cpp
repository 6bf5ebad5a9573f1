#include "Stage.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <fstream>

namespace sono {

std::map<std::string, Stage::Run>& Stage::all()
{
  static std::map<std::string, Run> stages;
  return stages;
}

void printFigure(const std::string& name, double value, const std::string& unit, const std::string& asked)
{
  const std::string beside = asked.empty() ? "" : " (asked: " + asked + ")";
  std::printf("%s %.6g %s%s\n", name.c_str(), value, unit.c_str(), beside.c_str());
  std::fflush(stdout);
}

double peakMegabytes()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6; // Linux counts in KiB
}

double residentMegabytes()
{
  std::ifstream stream("/proc/self/statm");
  double pages = 0.0;
  stream >> pages >> pages; // the second
  return pages * double(sysconf(_SC_PAGESIZE)) / 1e6;
}

} // namespace sono

int main(int argc, char** argv)
{
  const auto& stages = sono::Stage::all();
  const auto stage = argc == 2 ? stages.find(argv[1]) : stages.end();
  if (stage == stages.end())
  {
    std::fprintf(stderr, "usage: measure STAGE, with one of the stages");
    for (const auto& [name, run] : stages)
    {
      std::fprintf(stderr, " %s", name.c_str());
    }
    std::fprintf(stderr, "\n");
    return 2;
  }
  try
  {
    stage->second();
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "measure %s: %s\n", argv[1], error.what());
    return 1;
  }
  return 0;
}
