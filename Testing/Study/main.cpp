#include "Report.h"
#include "Study.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

namespace {

int usage()
{
  std::fprintf(stderr, "usage: study FOLDER [--quick] [PART...], with the parts report");
  for (const auto& [name, run] : sono::study::Part::all())
  {
    std::fprintf(stderr, " %s", name.c_str());
  }
  std::fprintf(stderr, "\n");
  return 2;
}

} // namespace

int main(int argc, char** argv)
{
  using namespace sono::study;
  std::vector<std::string> words(argv + 1, argv + argc);
  const auto flag = std::find(words.begin(), words.end(), "--quick");
  const bool quick = flag != words.end();
  if (quick)
  {
    words.erase(flag);
  }
  if (words.empty() || words.front().rfind("--", 0) == 0)
  {
    return usage();
  }
  const std::string folder = words.front();
  std::vector<std::string> names(words.begin() + 1, words.end());
  if (names.empty())
  {
    for (const auto& [name, run] : Part::all())
    {
      names.push_back(name);
    }
    names.push_back("report");
  }
  for (const std::string& name : names)
  {
    const auto part = Part::all().find(name);
    if (name != "report" && part == Part::all().end())
    {
      return usage();
    }
    try
    {
      if (name == "report")
      {
        writeReport(folder);
        continue;
      }
      Output output(folder, name, quick);
      part->second(output);
      output.finish();
    }
    catch (const std::exception& error)
    {
      std::fprintf(stderr, "study %s: %s\n", name.c_str(), error.what());
      return 1;
    }
  }
  return 0;
}
