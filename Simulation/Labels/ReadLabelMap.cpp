#include "Labels/ReadLabelMap.h"

#include "Core/Progress.h"
#include "Labels/CsvFile.h"
#include "Labels/KnownNumbers.h"
#include "Labels/LabelTable.h"
#include "Labels/ReadMeta.h"
#include "Labels/ReadNifti.h"
#include "Labels/ReadNrrd.h"
#include "Labels/VoxelFile.h"

#include <cmath>
#include <fstream>
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

} // namespace

LabelPhases readLabelPhases(const std::string& path)
{
  needVoxelFile(path, 0);
  return isNiftiName(path) ? readNiftiPhases(path) : LabelPhases();
}

LabelVolume readLabelMap(const std::string& path, int phase, const Progress& progress)
{
  needVoxelFile(path, phase);
  LabelVolume volume;
  try
  {
    if (isNiftiName(path))
    {
      volume = readNifti(path, phase, progress);
    }
    else
    {
      volume = isMetaName(path) ? readMeta(path, progress) : readNrrd(path, progress);
    }
  }
  catch (const std::bad_alloc&)
  {
    throw Error("cannot read '" + path + "': it does not fit into memory; crop or resample it.");
  }
  const std::string table = labelTableBeside(path.substr(0, path.size() - voxelFileEnding(path).size()));
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
