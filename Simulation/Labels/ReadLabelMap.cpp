#include "Labels/ReadLabelMap.h"

#include "Core/Progress.h"
#include "Labels/CsvFile.h"
#include "Labels/KnownNumbers.h"
#include "Labels/LabelTable.h"
#include "Labels/ReadDicomSeg.h"
#include "Labels/ReadMaskFolder.h"
#include "Labels/ReadMeta.h"
#include "Labels/ReadNifti.h"
#include "Labels/ReadNrrd.h"
#include "Labels/VoxelFile.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <new>
#include <set>

namespace sono {

namespace {

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

bool isFolder(const std::string& path)
{
  std::error_code error;
  return std::filesystem::is_directory(path, error);
}

LabelVolume readVoxels(const std::string& path, int phase, const Progress& progress)
{
  if (isNiftiName(path))
  {
    return readNifti(path, phase, progress);
  }
  return isMetaName(path) ? readMeta(path, progress) : readNrrd(path, progress);
}

/// Names of a table beside the label map STEM.nii for labels that the file itself does not name.
void addNamesBeside(const std::string& stem, LabelVolume& volume)
{
  const std::string table = labelTableBeside(stem);
  if (table.empty())
  {
    return;
  }
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

} // namespace

LabelPhases readLabelPhases(const std::string& path)
{
  if (!isNiftiName(path))
  {
    return LabelPhases();
  }
  needVoxelFile(path, 0);
  return readNiftiPhases(path);
}

GridPlacement readLabelPlacement(const std::string& path)
{
  if (isFolder(path))
  {
    return maskFolderPlacement(path);
  }
  return isDicomFile(path) ? dicomSegPlacement(path) : openVoxels(path).placement;
}

LabelVolume readLabelMap(const std::string& path, int phase, const Progress& progress)
{
  LabelVolume volume;
  std::string stem = path;
  try
  {
    if (isFolder(path))
    {
      return readMaskFolder(path, progress);
    }
    if (isDicomFile(path))
    {
      volume = readDicomSeg(path, progress);
      stem = std::filesystem::path(path).replace_extension().string();
    }
    else
    {
      needVoxelFile(path, phase);
      volume = readVoxels(path, phase, progress);
      stem.resize(stem.size() - voxelFileEnding(path).size());
    }
  }
  catch (const std::bad_alloc&)
  {
    throw Error("cannot read '" + path + "': it does not fit into memory; crop or resample it.");
  }
  addNamesBeside(stem, volume);
  volume.collectLabels();
  nameKnownNumbers(volume);
  return volume;
}

void readLabelTable(const std::string& tablePath, LabelVolume& volume)
{
  describeLabels(readLabels(tablePath), volume);
}

void describeLabels(const std::vector<LabelInfo>& rows, LabelVolume& volume)
{
  std::multimap<int, LabelInfo*> ofId; // a table may have as many rows as there are ids
  for (LabelInfo& label : volume.labels)
  {
    ofId.emplace(label.id, &label);
  }
  for (const LabelInfo& row : rows)
  {
    const auto [first, last] = ofId.equal_range(row.id);
    std::for_each(first, last, [&row](const auto& label) { copyDescription(row, *label.second); });
  }
}

void writeLabelMap(const std::string& path, const LabelVolume& volume)
{
  const std::string ending = voxelFileEnding(path);
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
