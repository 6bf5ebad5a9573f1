#include "DataSets/WriteDataSet.h"

#include "Core/WholeFile.h"
#include "DataSets/ImageWorkers.h"
#include "Image/PngFile.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <ostream>
#include <set>

namespace sono {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* infoFolder = "info";
constexpr const char* channelFolder = "channels";
constexpr const char* beamFolder = "beam";
constexpr const char* sourceFile = "dataset_source.json";

/// Where the files of an image lie in the folder.
struct CaseFiles
{
  std::string image;
  std::string mask;
  std::string info;
  std::string channels; ///< empty: none
  std::string beam;
};

bool asksFor(const DataSet& set, ImageChannel channel)
{
  return std::find(set.channels.begin(), set.channels.end(), channel) != set.channels.end();
}

CaseFiles filesOf(const DataSetPlan& plan, std::int64_t index)
{
  const std::string name = plan.caseName(index);
  const bool hasBeam = asksFor(plan.set(), ImageChannel::Beam);
  const bool hasPixels = plan.set().channels.size() > (hasBeam ? 1u : 0u);
  CaseFiles files;
  files.info = std::string(infoFolder) + "/" + name + ".json";
  files.channels = hasPixels ? channelFolder + ("/" + name) + ".exr" : "";
  files.beam = hasBeam ? beamFolder + ("/" + name) + ".exr" : "";
  if (plan.set().format == DataSetFormat::Monai)
  {
    files.image = "images/" + name + ".png";
    files.mask = "labels/" + name + ".png";
    return files;
  }
  const std::string end = plan.splitOf(index) == Split::Test ? "Ts/" : "Tr/";
  files.image = "images" + end + name + "_0000.png";
  files.mask = "labels" + end + name + ".png";
  return files;
}

std::vector<std::string> foldersOf(const DataSetPlan& plan)
{
  std::vector<std::string> folders =
    plan.set().format == DataSetFormat::Monai
      ? std::vector<std::string>{ "images", "labels", infoFolder }
      : std::vector<std::string>{ "imagesTr", "labelsTr", "imagesTs", "labelsTs", infoFolder };
  const CaseFiles files = filesOf(plan, 0);
  if (!files.channels.empty())
  {
    folders.emplace_back(channelFolder);
  }
  if (!files.beam.empty())
  {
    folders.emplace_back(beamFolder);
  }
  return folders;
}

void write(const fs::path& path, const std::function<void(std::ostream&)>& content)
{
  if (!writeWholeFile(path.string(), content))
  {
    throw Error("cannot write '" + path.string() +
                "': its folder is protected or the disk is full; make room, or choose another folder.");
  }
}

void write(const fs::path& path, const std::string& bytes)
{
  write(path, [&](std::ostream& out) { out.write(bytes.data(), std::streamsize(bytes.size())); });
}

/// Number of the image that a file of the data set belongs to, from its name; none of others.
std::optional<std::int64_t> imageOf(const DataSetPlan& plan, const std::string& file)
{
  const std::string begin = plan.set().name + "_";
  const std::size_t end = file.find_first_not_of("0123456789", begin.size());
  if (file.compare(0, begin.size(), begin) != 0 || end == std::string::npos || end == begin.size() ||
      end - begin.size() > 18)
  {
    return std::nullopt;
  }
  return std::stoll(file.substr(begin.size(), end - begin.size()));
}

/// What a killed process has left half written of these images.
void removeParts(const DataSetPlan& plan, const fs::path& folder, const PlannedRange& images)
{
  for (const std::string& sub : foldersOf(plan))
  {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / sub))
    {
      if (entry.path().extension() == ".part")
      {
        const auto index = imageOf(plan, entry.path().filename().string());
        if (index && *index >= images.first && *index < images.end)
        {
          std::error_code ignored;
          fs::remove(entry.path(), ignored);
        }
      }
    }
  }
}

/// Makes the folders, or finds that they are of the same data set.
void claim(const DataSetPlan& plan, const fs::path& folder)
{
  std::error_code error;
  for (const std::string& sub : foldersOf(plan))
  {
    fs::create_directories(folder / sub, error);
  }
  if (error)
  {
    throw Error("cannot make the folder '" + folder.string() + "': " + error.message() + "; choose another one.");
  }
  std::ifstream stream(folder / sourceFile, std::ios::binary);
  if (!stream)
  {
    write(folder / sourceFile, plan.set().text);
  }
  else if (std::string(std::istreambuf_iterator<char>(stream), {}) != plan.set().text)
  {
    throw Error("'" + folder.string() + "' holds images of another data set, or of an earlier '" + plan.set().path +
                "'; choose an empty folder.");
  }
}

/// Keys and values without the brackets around them, so that a list can follow that is too long to be held.
std::string open(const Json& json)
{
  std::string text = json.dump(1);
  text.resize(text.size() - 2); // "\n}"
  return text;
}

/// A list of the images of some splits, an entry a line.
template<class Entry>
void writeList(const DataSetPlan& plan, std::initializer_list<Split> splits, const Entry& entry, std::ostream& out)
{
  out << "[";
  const char* separator = "\n  ";
  for (std::int64_t index = 0; index < plan.imageCount(); ++index)
  {
    if (std::find(splits.begin(), splits.end(), plan.splitOf(index)) != splits.end())
    {
      out << separator << entry(index);
      separator = ",\n  ";
    }
  }
  out << "\n ]";
}

Json licencesOf(const DataSet& set)
{
  std::set<std::string> licences;
  for (const DataSetPatient& patient : set.patients)
  {
    licences.insert(patient.licence);
  }
  return licences;
}

void writeNnUNetLists(const DataSetPlan& plan, const fs::path& folder)
{
  const DataSet& set = plan.set();
  Json json = { { "name", set.name }, { "description", set.description }, { "licence", licencesOf(set) } };
  json["channel_names"] = { { "0", "ultrasound" } };
  json["labels"]["background"] = 0;
  for (std::size_t group = 0; group < set.masks.size(); ++group)
  {
    json["labels"][set.masks[group].name] = group + 1;
  }
  json["numTraining"] = plan.imagesIn(Split::Train) + plan.imagesIn(Split::Validation);
  json["file_ending"] = ".png";
  json["overwrite_image_reader_writer"] = "NaturalImage2DIO";
  write(folder / "dataset.json", json.dump(1) + "\n");
  const auto name = [&](std::int64_t index) { return '"' + plan.caseName(index) + '"'; };
  write(folder / "splits_final.json", [&](std::ostream& out) {
    out << "[{\n \"train\": ";
    writeList(plan, { Split::Train }, name, out);
    out << ",\n \"val\": ";
    writeList(plan, { Split::Validation }, name, out);
    out << "\n}]\n";
  });
}

void writeMonaiList(const DataSetPlan& plan, const fs::path& folder)
{
  const DataSet& set = plan.set();
  Json json = { { "name", set.name }, { "description", set.description }, { "licence", licencesOf(set) } };
  json["tensorImageSize"] = "2D";
  json["modality"] = { { "0", "ultrasound" } };
  json["labels"]["0"] = "background";
  for (std::size_t group = 0; group < set.masks.size(); ++group)
  {
    json["labels"][std::to_string(group + 1)] = set.masks[group].name;
  }
  json["numTraining"] = plan.imagesIn(Split::Train);
  json["numTest"] = plan.imagesIn(Split::Test);
  const auto entry = [&](std::int64_t index) {
    const CaseFiles files = filesOf(plan, index);
    std::string text =
      R"({"image": ")" + files.image + R"(", "label": ")" + files.mask + R"(", "info": ")" + files.info;
    text += files.channels.empty() ? "" : R"(", "channels": ")" + files.channels;
    text += files.beam.empty() ? "" : R"(", "beam": ")" + files.beam;
    return text + "\"}";
  };
  write(folder / "dataset.json", [&](std::ostream& out) {
    out << open(json) << ",\n \"training\": ";
    writeList(plan, { Split::Train }, entry, out);
    out << ",\n \"validation\": ";
    writeList(plan, { Split::Validation }, entry, out);
    out << ",\n \"test\": ";
    writeList(plan, { Split::Test }, entry, out);
    out << "\n}\n";
  });
}

void writeImage(const DataSetImage& image, const CaseFiles& files, const fs::path& folder, const EncodeExr& encode)
{
  write(folder / files.image, pngBytes(image.grey.data(), image.width, image.height, image.pixelMm));
  write(folder / files.mask, pngBytes(image.mask.data(), image.width, image.height, image.pixelMm));
  if (!files.channels.empty())
  {
    write(folder / files.channels, encode(image.channels));
  }
  if (!files.beam.empty())
  {
    write(folder / files.beam, encode(image.beam));
  }
  write(folder / files.info, image.info); // the last
}

} // namespace

DataSetTally writeDataSet(DataSetImager& imager, const std::string& folderName, const DataSetShare& share,
                          const Progress& progress, const std::function<void(const DataSetTally&)>& tell, int workers,
                          const EncodeExr& encode)
{
  if (folderName.empty())
  {
    throw Error("no folder is named for the data set; name one.");
  }
  const fs::path folder(folderName);
  const DataSetPlan& plan = imager.plan();
  if (!plan.set().channels.empty() && !encode)
  {
    throw Error("'" + plan.set().path +
                "': 'channels' go into OpenEXR files, which this program cannot write; remove "
                "them, or write the data set in ParaView.");
  }
  const PlannedRange images = plan.imagesOf(share);
  claim(plan, folder);
  removeParts(plan, folder, images);
  if (share.rank == 0)
  {
    plan.set().format == DataSetFormat::Monai ? writeMonaiList(plan, folder) : writeNnUNetLists(plan, folder);
  }
  DataSetTally tally;
  tally.total = images.end - images.first;
  std::atomic<std::int64_t> made{ 0 };
  const auto begin = std::chrono::steady_clock::now();
  const auto work = [&](DataSetImager& by, const PlannedRange& exam, const std::function<void()>& done,
                        const Progress& untilStopped) {
    std::vector<std::int64_t> missing;
    for (std::int64_t index = exam.first; index < exam.end; ++index)
    {
      if (fs::exists(folder / filesOf(plan, index).info))
      {
        done();
      }
      else
      {
        missing.push_back(index);
      }
    }
    const auto write = [&](std::int64_t index, const DataSetImage& image) {
      writeImage(image, filesOf(plan, index), folder, encode);
      ++made;
      done();
    };
    if (!missing.empty())
    {
      by.makeEach(missing, write, untilStopped);
    }
  };
  const auto keepsOn = [&](double) { return !progress || progress(double(tally.done) / double(tally.total)); };
  const auto hear = [&] {
    ++tally.done;
    tally.made = made;
    tally.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (tell)
    {
      tell(tally);
    }
  };
  const int threads = workers > 0 ? workers : imageWorkers(imager);
  forExams(imager, workUnits(plan, images, threads), threads, work, hear, keepsOn);
  return tally;
}

} // namespace sono
