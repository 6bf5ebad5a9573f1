#include "Targets.h"

#include "Core/Error.h"
#include "Files/ReadTracked.h"
#include "Labels/AssignTissues.h"
#include "Labels/LabelTable.h"
#include "Labels/ReadIntensities.h"
#include "Labels/ReadLabelMap.h"
#include "Labels/TissueTable.h"
#include "Probe/PulseEchoFieldFile.h"
#include "Probe/PulseFile.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace sono::fuzz {

namespace {

/// What a bad file may do is throw Error; anything else ends the program.
template<class Work>
void attempt(Work work)
{
  try
  {
    work();
  }
  catch (const Error&)
  {
  }
}

void readVolume(const std::string& path)
{
  attempt([&] { readLabelPlacement(path); });
  attempt([&] { readLabelPhases(path); });
  attempt([&] { readLabelMap(path); });
  attempt([&] { readIntensities(path); });
}

void readTable(const std::string& path)
{
  attempt([&] { readLabels(path); });
}

} // namespace

const std::vector<Target>& targets()
{
  static const std::vector<Target> list = {
    { "nifti", "x.nii", readVolume },
    { "nifti_gz", "x.nii.gz", readVolume },
    { "nrrd", "x.seg.nrrd", readVolume },
    { "meta", "x.mha", readVolume },
    { "dicom_seg", "x.dcm", [](const std::string& path) { attempt([&] { readLabelMap(path); }); } },
    { "dicom_series", "x.dcm", [](const std::string& path) { attempt([&] { readIntensities(path); }); } },
    { "masks", "x.nii",
      [](const std::string& path) {
        attempt([&] { readLabelMap(std::filesystem::path(path).parent_path().string()); });
      } },
    { "label_csv", "x.csv", readTable },
    { "label_snap", "x.label", readTable },
    { "label_ctbl", "x.ctbl", readTable },
    { "label_txt", "x.txt", readTable },
    { "label_tsv", "x.tsv", readTable },
    { "tissues", "x.csv", [](const std::string& path) { attempt([&] { TissueTable::read(path); }); } },
    { "label_tissues", "x.csv", [](const std::string& path) { attempt([&] { LabelTissueMap::read(path); }); } },
    { "pulse", "x.csv", [](const std::string& path) { attempt([&] { readPulse(path); }); } },
    { "tracked", "x.igs.mha",
      [](const std::string& path) {
        attempt([&] { readTracked(path, "ProbeToReference", Mat4d(1.0), Mat4d(1.0)); });
      } },
    { "field", "x.nrrd", [](const std::string& path) { attempt([&] { readPulseEchoField(path); }); } },
  };
  return list;
}

const Target& targetOf(const std::string& name)
{
  for (const Target& target : targets())
  {
    if (target.name == name)
    {
      return target;
    }
  }
  throw std::invalid_argument("no target is named '" + name + "'");
}

std::string workFolder()
{
  // One of its own, since readers look at what lies beside a file, too; in memory, where a write takes no time.
  static const std::string folder = [] {
    const std::string memory = "/dev/shm";
    const std::string parent =
      std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path().string();
    const std::string own = parent + "/sono_fuzz_" + std::to_string(getpid());
    std::filesystem::create_directories(own);
    return own;
  }();
  return folder;
}

void run(const Target& target, const std::uint8_t* bytes, std::size_t count)
{
  const std::string path = workFolder() + "/" + target.fileName;
  std::ofstream(path, std::ios::binary | std::ios::trunc)
    .write(reinterpret_cast<const char*>(bytes), std::streamsize(count));
  target.read(path);
}

} // namespace sono::fuzz

/// libFuzzer's entry: SONOVDB_FUZZ names the target.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count)
{
  static const char* const name = std::getenv("SONOVDB_FUZZ");
  static const sono::fuzz::Target& target = sono::fuzz::targetOf(name ? name : "");
  sono::fuzz::run(target, bytes, count);
  return 0;
}
