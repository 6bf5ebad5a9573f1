#include "Labels/ReadMaskFolder.h"

#include "Core/ParallelFor.h"
#include "Labels/LabelRuns.h"
#include "Labels/VoxelFile.h"
#include "Labels/VoxelRuns.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <new>
#include <sstream>

namespace sono {

namespace {

namespace fs = std::filesystem;

/// The files of a label map's formats in a folder, in the order of their names.
std::vector<std::string> filesIn(const std::string& folder)
{
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
  {
    const std::string name = entry.path().filename().string();
    if (!voxelFileEnding(name).empty() && name[0] != '.' && entry.is_regular_file(error))
    {
      names.push_back(entry.path().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> masksIn(const std::string& folder)
{
  const std::vector<std::string> files = filesIn(folder);
  if (!files.empty())
  {
    if (files.size() > 65535)
    {
      throw Error("'" + folder + "' holds " + std::to_string(files.size()) +
                  " masks, more than a label map can number; choose a folder of one patient.");
    }
    return files;
  }
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
  {
    if (entry.is_directory(error) && !filesIn(entry.path().string()).empty())
    {
      throw Error("'" + folder + "' holds no masks (.nii, .nii.gz, .nrrd, .mha, ...) itself; choose its folder '" +
                  entry.path().filename().string() + "'.");
    }
  }
  throw Error("'" + folder +
              "' holds no masks; choose a folder with one .nii, .nii.gz, .nrrd or .mha file a structure.");
}

std::string structureName(const std::string& path)
{
  const std::string name = fs::path(path).filename().string();
  return name.substr(0, name.size() - voxelFileEnding(name).size());
}

[[noreturn]] void refuseNumbers(const std::string& path, double first, double second)
{
  std::ostringstream message;
  message << "'" << path << "' is no mask: it holds " << first << " and " << second
          << "; open it alone as a label map, or move it out of the folder.";
  throw Error(message.str());
}

VoxelRuns readMask(VoxelFile& file, const Progress& progress)
{
  if (file.layers > 1)
  {
    throw Error("'" + file.path + "' is no mask: it holds several layers; open it alone as a label map.");
  }
  VoxelRuns mask;
  double set = 0.0; // the number that the structure has
  readNumbers(file, progress, [&](const auto* numbers, std::size_t count, std::size_t position) {
    using T = std::decay_t<decltype(*numbers)>;
    for (std::size_t n = firstOther(numbers, 0, count, T(0)); n < count; n = firstOther(numbers, n, count, T(0)))
    {
      const double value = double(numbers[n]);
      if (!std::isfinite(value) || (set != 0.0 && value != set))
      {
        refuseNumbers(file.path, set, value);
      }
      set = value;
      const std::size_t begin = n;
      n = firstOther(numbers, begin, count, numbers[begin]);
      mask.add(position + begin, n - begin);
    }
  });
  return mask;
}

std::string text(const Vec3d& v)
{
  std::ostringstream stream;
  stream << "(" << v.x << ", " << v.y << ", " << v.z << ")";
  return stream.str();
}

/// What differs between two places; empty: nothing that matters.
std::string difference(const GridPlacement& a, const GridPlacement& b)
{
  const Vec3d spacing = a.spacingMm;
  const double toleranceMm = 0.05 * std::min({ spacing.x, spacing.y, spacing.z });
  if (a.size != b.size)
  {
    return "have " + text(Vec3d(a.size)) + " and " + text(Vec3d(b.size)) + " voxels";
  }
  if (glm::length(a.originMm - b.originMm) > toleranceMm)
  {
    return "begin at " + text(a.originMm) + " and " + text(b.originMm) + " mm";
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    Vec3d last(0.0);
    last[axis] = double(a.size[axis] - 1);
    if (glm::length(a.worldFromIndex(last) - b.worldFromIndex(last)) > toleranceMm)
    {
      return "have voxels of " + text(spacing) + " and " + text(b.spacingMm) + " mm, or axes in other directions";
    }
  }
  return {};
}

} // namespace

GridPlacement maskFolderPlacement(const std::string& folder)
{
  return openVoxels(masksIn(folder).front()).placement;
}

LabelVolume readMaskFolder(const std::string& folder, const Progress& progress)
{
  const std::vector<std::string> paths = masksIn(folder);
  LabelVolume volume;
  volume.placement = openVoxels(paths.front()).placement;
  std::vector<Structure> structures(paths.size());
  std::vector<std::string> errors(paths.size()); // the first by name is told, whichever thread was first
  parallelFor(int(paths.size()), progress, [&](int i, const YieldPoint& yield) {
    const std::size_t n = std::size_t(i);
    try
    {
      VoxelFile file = openVoxels(paths[n]);
      const std::string other = difference(volume.placement, file.placement);
      if (!other.empty())
      {
        throw Error("'" + paths.front() + "' and '" + paths[n] + "' are not of one patient's grid: they " + other +
                    "; resample one onto the other, or move it out of the folder.");
      }
      structures[n] = { std::uint16_t(n + 1), structureName(paths[n]), readMask(file, Progress([&](double) {
                                                                                  yield();
                                                                                  return true;
                                                                                })) };
    }
    catch (const Error& error)
    {
      errors[n] = error.what();
    }
    catch (const std::bad_alloc&)
    {
      errors[n] = "cannot read '" + paths[n] + "': it does not fit into memory; crop or resample the masks.";
    }
  });
  for (const std::string& error : errors)
  {
    if (!error.empty())
    {
      throw Error(error);
    }
  }
  FlattenedStructures flat =
    flattenStructures(structures, volume.placement.voxelCount(), "the folder '" + folder + "'");
  volume.voxels = std::move(flat.voxels);
  volume.notice = std::move(flat.overlap);
  for (const Structure& structure : structures)
  {
    LabelInfo label;
    label.id = structure.label;
    label.name = structure.name;
    volume.labels.push_back(std::move(label));
  }
  volume.collectLabels();
  return volume;
}

std::string maskFolderOf(const std::string& path)
{
  std::error_code error;
  if (fs::is_directory(path, error))
  {
    return path;
  }
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

bool mayBeMasks(const std::string& path)
{
  const std::size_t files = filesIn(maskFolderOf(path)).size();
  std::error_code error;
  if (fs::is_directory(path, error) || voxelFileEnding(path).empty() || files < 2)
  {
    return fs::is_directory(path, error) && files > 0;
  }
  try
  {
    VoxelFile file = openVoxels(path);
    readMask(file, {});
    return true;
  }
  catch (const Error&)
  {
    return false;
  }
}

} // namespace sono
