#include "Labels/ReadLabelMap.h"

#include "Core/Progress.h"
#include "Labels/CsvFile.h"
#include "Labels/KnownNumbers.h"
#include "Labels/LabelTable.h"
#include "Labels/ReadMeta.h"
#include "Labels/ReadNifti.h"
#include "Labels/ReadNrrd.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <new>
#include <set>
#include <stdexcept>

namespace sono {

namespace {

namespace fs = std::filesystem;

/// The known ending of a file name, in lower case; empty for another one.
std::string knownEnding(const std::string& path)
{
  std::string lower = path;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  for (const std::string ending : { ".nii.gz", ".nii", ".seg.nrrd", ".nrrd", ".nhdr", ".mha", ".mhd" })
  {
    if (lower.size() > ending.size() && lower.compare(lower.size() - ending.size(), ending.size(), ending) == 0)
    {
      return ending;
    }
  }
  return {};
}

void needReadable(const std::string& path, const std::string& ending)
{
  if (ending.empty())
  {
    throw Error("cannot read '" + path +
                "': its name ends in none of .nii, .nii.gz, .nrrd, .nhdr, .seg.nrrd, .mha, .mhd; convert it.");
  }
  std::error_code error;
  if (!fs::is_regular_file(path, error) || !std::ifstream(path))
  {
    throw Error("cannot read '" + path + "': no such file, or no permission to read it.");
  }
}

bool isNifti(const std::string& ending)
{
  return ending.compare(0, 4, ".nii") == 0;
}

LabelVolume readByEnding(const std::string& path, const std::string& ending, int phase)
{
  needReadable(path, ending);
  if (phase != 0 && !isNifti(ending))
  {
    throw Error("'" + path + "' holds one label map, so phase " + std::to_string(phase) + " is not in it; choose 0.");
  }
  try
  {
    if (ending.compare(0, 3, ".mh") == 0)
    {
      return readMeta(path);
    }
    return isNifti(ending) ? readNifti(path, phase) : readNrrd(path);
  }
  catch (const std::bad_alloc&)
  {
    throw Error("cannot read '" + path + "': it does not fit into memory; crop or resample it.");
  }
}

void copyDescription(const LabelInfo& from, LabelInfo& to)
{
  if (!from.name.empty())
  {
    to.name = from.name;
  }
  if (!from.code.empty())
  {
    to.code = from.code;
  }
  if (from.hasColor)
  {
    to.color = from.color;
    to.hasColor = true;
  }
  if (!from.tissue.empty())
  {
    to.tissue = from.tissue;
  }
}

} // namespace

LabelPhases readLabelPhases(const std::string& path)
{
  const std::string ending = knownEnding(path);
  needReadable(path, ending);
  return isNifti(ending) ? readNiftiPhases(path) : LabelPhases();
}

LabelVolume readLabelMap(const std::string& path, int phase)
{
  const std::string ending = knownEnding(path);
  LabelVolume volume = readByEnding(path, ending, phase);
  const std::string table = labelTableBeside(path.substr(0, path.size() - ending.size()));
  if (!table.empty())
  {
    std::set<int> named;
    for (const LabelInfo& label : volume.labels)
    {
      if (!label.name.empty())
      {
        named.insert(label.id);
      }
    }
    for (LabelInfo& label : readLabels(table))
    {
      if (named.count(label.id) == 0)
      {
        volume.labels.push_back(std::move(label));
      }
    }
  }
  volume.collectLabels();
  nameKnownNumbers(volume);
  return volume;
}

void readLabelTable(const std::string& tablePath, LabelVolume& volume)
{
  for (const LabelInfo& row : readLabels(tablePath))
  {
    for (LabelInfo& label : volume.labels)
    {
      if (label.id == row.id)
      {
        copyDescription(row, label);
      }
    }
  }
}

void writeLabelMap(const std::string& path, const LabelVolume& volume)
{
  const std::string ending = knownEnding(path);
  if (ending != ".nii" && ending != ".nii.gz")
  {
    throw Error("cannot write '" + path + "': its name must end in .nii or .nii.gz.");
  }
  volume.placement.validate(path);
  if (volume.voxels.size() != volume.placement.voxelCount())
  {
    throw Error("cannot write '" + path + "': the volume has " + std::to_string(volume.voxels.size()) +
                " voxels for a grid of " + std::to_string(volume.placement.voxelCount()) + ".");
  }
  writeNifti(path, volume);

  const std::string tablePath = path.substr(0, path.size() - ending.size()) + ".csv";
  std::ofstream table(tablePath, std::ios::binary);
  table << "id,name,r,g,b\n";
  for (const LabelInfo& label : volume.labels)
  {
    table << std::to_string(label.id) << ',' << csvField(label.name);
    for (const float channel : label.color)
    {
      table << ',' << (label.hasColor ? std::to_string(std::lround(255.0 * double(channel))) : "");
    }
    table << '\n';
  }
  if (!table.flush())
  {
    throw Error("cannot write '" + tablePath + "': the disk may be full or the file protected.");
  }
}

} // namespace sono
