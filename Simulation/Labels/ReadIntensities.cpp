#include "Labels/ReadIntensities.h"

#include "Labels/ReadDicomSeries.h"
#include "Labels/ReadNifti.h"
#include "Labels/VoxelFile.h"

#include <cmath>
#include <filesystem>
#include <new>

namespace sono {

namespace {

IntensityVolume readVoxelFile(const std::string& path, const Progress& progress)
{
  VoxelFile file = openVoxels(path);
  const int volumes = isNiftiName(path) ? readNiftiPhases(path).count : int(file.layers);
  if (volumes > 1)
  {
    throw Error("'" + path + "' holds " + std::to_string(volumes) +
                " volumes; save the one that belongs to the labels.");
  }
  file.bytes.need(file.numbers() * bytesOf(file.type)); // before memory is taken for them
  IntensityVolume volume;
  volume.placement = file.placement;
  volume.values.resize(std::size_t(file.numbers()));
  readNumbers(file, progress, [&](const auto* numbers, std::size_t count, std::size_t position) {
    float* const values = volume.values.data() + position;
    bool finite = true;
    for (std::size_t n = 0; n < count; ++n)
    {
      values[n] = float(file.slope * double(numbers[n]) + file.intercept);
      finite = finite && std::isfinite(values[n]);
    }
    if (!finite)
    {
      throw Error("'" + path + "' holds a number that is not finite; save it with a number in the place of NaN.");
    }
  });
  return volume;
}

} // namespace

IntensityVolume readIntensities(const std::string& path, const Progress& progress)
{
  try
  {
    std::error_code error;
    const bool isSeries = std::filesystem::is_directory(path, error) || isDicomFile(path);
    return isSeries ? readDicomSeries(path, progress) : readVoxelFile(path, progress);
  }
  catch (const std::bad_alloc&)
  {
    throw Error("cannot read '" + path + "': it does not fit into memory; crop or resample it.");
  }
}

} // namespace sono
