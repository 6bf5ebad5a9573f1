#include "Labels/ReadNrrd.h"

#include "Core/Progress.h"
#include "Labels/CsvFile.h"
#include "Labels/LabelCode.h"
#include "Labels/LabelConversion.h"
#include "Labels/NrrdFile.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <utility>

namespace sono {

namespace {

/// The factors that turn the file's world axes into LPS. This is the one place where NRRD's frame is changed.
Vec3d signsToLps(const Nrrd& nrrd, const std::string& path)
{
  switch (nrrd.space)
  {
    case nrrdSpaceLeftPosteriorSuperior:
      return { 1.0, 1.0, 1.0 };
    case nrrdSpaceRightAnteriorSuperior:
      return { -1.0, -1.0, 1.0 };
    case nrrdSpaceLeftAnteriorSuperior:
      return { 1.0, -1.0, 1.0 };
    default:
      throw Error("'" + path +
                  "' does not say how its axes lie in the patient; set its space to "
                  "left-posterior-superior, right-anterior-superior or left-anterior-superior.");
  }
}

/// Which of the file's axes are i, j, k, and which one, if any, counts overlapping layers.
struct Axes
{
  std::vector<unsigned> spatial;
  int layers = -1;
};

Axes findAxes(const Nrrd& nrrd, const std::string& path)
{
  Axes axes;
  for (unsigned axis = 0; axis < nrrd.dim; ++axis)
  {
    const bool spatial = nrrd.spaceDim == 0 || std::isfinite(nrrd.axis[axis].spaceDirection[0]);
    if (spatial && axes.spatial.size() < 3)
    {
      axes.spatial.push_back(axis);
    }
    else if (nrrd.axis[axis].size > 1 || axis == 0)
    {
      if (axes.layers >= 0 || (axis != 0 && axis != nrrd.dim - 1))
      {
        throw Error("'" + path + "' has more than three dimensions; choose one volume of it.");
      }
      axes.layers = int(axis);
    }
  }
  if (axes.spatial.size() != 3)
  {
    throw Error("'" + path + "' has " + std::to_string(axes.spatial.size()) +
                " spatial axes; a label map has three, each with a space direction.");
  }
  return axes;
}

GridPlacement placementOf(const Nrrd& nrrd, const Axes& axes, const std::string& path)
{
  Vec3i size(0);
  Mat3d columns(0.0);
  Vec3d origin(0.0);
  const Vec3d sign = nrrd.spaceDim == 0 ? Vec3d(1.0) : signsToLps(nrrd, path);
  for (int n = 0; n < 3; ++n)
  {
    const NrrdAxisInfo& axis = nrrd.axis[axes.spatial[std::size_t(n)]];
    size[n] = int(std::min(axis.size, std::size_t(1) << 30));
    if (nrrd.spaceDim == 0)
    {
      columns[n][n] = std::isfinite(axis.spacing) ? std::abs(axis.spacing) : 1.0;
      continue;
    }
    for (int row = 0; row < 3; ++row)
    {
      columns[n][row] = sign[row] * axis.spaceDirection[row];
    }
    origin[n] = std::isfinite(nrrd.spaceOrigin[n]) ? sign[n] * nrrd.spaceOrigin[n] : 0.0;
    const std::string unit = nrrd.spaceUnits[n] ? nrrd.spaceUnits[n] : "";
    if (!unit.empty() && unit != "mm" && unit.compare(0, 10, "millimeter") != 0)
    {
      throw Error("'" + path + "' is in '" + unit + "'; save it in mm.");
    }
  }
  return placementFromAffine(size, columns, origin, path);
}

std::vector<std::uint16_t> readNumbers(const Nrrd& nrrd, const LabelConversion& conversion)
{
  const std::size_t count = nrrdElementNumber(&nrrd);
  std::vector<std::uint16_t> numbers;
  numbers.reserve(count);
  switch (nrrd.type)
  {
    case nrrdTypeChar:
      conversion.append(numbers, static_cast<const signed char*>(nrrd.data), count);
      break;
    case nrrdTypeUChar:
      conversion.append(numbers, static_cast<const unsigned char*>(nrrd.data), count);
      break;
    case nrrdTypeShort:
      conversion.append(numbers, static_cast<const short*>(nrrd.data), count);
      break;
    case nrrdTypeUShort:
      conversion.append(numbers, static_cast<const unsigned short*>(nrrd.data), count);
      break;
    case nrrdTypeInt:
      conversion.append(numbers, static_cast<const int*>(nrrd.data), count);
      break;
    case nrrdTypeUInt:
      conversion.append(numbers, static_cast<const unsigned int*>(nrrd.data), count);
      break;
    case nrrdTypeLLong:
      conversion.append(numbers, static_cast<const airLLong*>(nrrd.data), count);
      break;
    case nrrdTypeULLong:
      conversion.append(numbers, static_cast<const airULLong*>(nrrd.data), count);
      break;
    case nrrdTypeFloat:
      conversion.append(numbers, static_cast<const float*>(nrrd.data), count);
      break;
    case nrrdTypeDouble:
      conversion.append(numbers, static_cast<const double*>(nrrd.data), count);
      break;
    default:
      throw Error("'" + conversion.path +
                  "' has voxels that are not numbers; a label map holds whole numbers 0..65535.");
  }
  return numbers;
}

/// A segment of a .seg.nrrd file.
struct Segment
{
  LabelInfo label;
  int value = 0; ///< the number in its layer's voxels
  int layer = 0;
};

std::string keyValue(const Nrrd& nrrd, std::size_t segment, const std::string& key)
{
  const std::string whole = "Segment" + std::to_string(segment) + "_" + key;
  const std::unique_ptr<char, void (*)(void*)> text(nrrdKeyValueGet(&nrrd, whole.c_str()), std::free);
  return text ? text.get() : "";
}

int keyNumber(const Nrrd& nrrd, std::size_t segment, const std::string& key, int fallback)
{
  const auto number = parseNumber(keyValue(nrrd, segment, key));
  return number && *number >= 0.0 && *number <= 65535.0 ? int(*number) : fallback;
}

void parseColor(const std::string& text, LabelInfo& label)
{
  std::istringstream stream(text);
  std::string part;
  std::size_t channels = 0;
  for (; channels < 3 && stream >> part; ++channels)
  {
    const auto number = parseNumber(part);
    if (!number)
    {
      break;
    }
    label.color[channels] = float(std::clamp(*number, 0.0, 1.0));
  }
  label.hasColor = channels == 3;
}

/// Segmentation_SourceRepresentation, which older versions of 3D Slicer call Segmentation_MasterRepresentation. Shares
/// of a voxel are no labels.
void refuseFractions(const Nrrd& nrrd, const std::string& path)
{
  for (const char* key : { "Segmentation_SourceRepresentation", "Segmentation_MasterRepresentation" })
  {
    const std::unique_ptr<char, void (*)(void*)> text(nrrdKeyValueGet(&nrrd, key), std::free);
    if (text && std::string(text.get()) != "Binary labelmap")
    {
      throw Error("'" + path + "' holds a " + text.get() + "; save the segmentation as a binary labelmap.");
    }
  }
}

/// Files of older versions of 3D Slicer have neither LabelValue nor Layer: then segment N is label N + 1 in a 3-D
/// file, and the mask in layer N of a 4-D one.
std::vector<Segment> readSegments(const Nrrd& nrrd, bool layered)
{
  std::vector<Segment> segments;
  for (std::size_t n = 0; !keyValue(nrrd, n, "ID").empty() || !keyValue(nrrd, n, "Name").empty(); ++n)
  {
    Segment segment;
    segment.value = keyNumber(nrrd, n, "LabelValue", layered ? 1 : int(n) + 1);
    segment.layer = keyNumber(nrrd, n, "Layer", layered ? int(n) : 0);
    segment.label.id = segment.value;
    segment.label.name = keyValue(nrrd, n, "Name");
    describeBySlicerTags(keyValue(nrrd, n, "Tags"), segment.label);
    parseColor(keyValue(nrrd, n, "Color"), segment.label);
    segments.push_back(std::move(segment));
  }
  return segments;
}

/// Label ids must differ; the values of segments in different layers need not.
void makeIdsUnique(std::vector<Segment>& segments)
{
  std::set<int> ids;
  for (const Segment& segment : segments)
  {
    ids.insert(segment.label.id);
  }
  for (std::size_t n = 0; ids.size() < segments.size() && n < segments.size(); ++n)
  {
    segments[n].label.id = int(n) + 1;
  }
}

std::vector<std::uint16_t> flattenLayers(const std::vector<std::uint16_t>& numbers, std::size_t layerCount,
                                         bool layersFirst, const std::vector<Segment>& segments,
                                         const std::string& path)
{
  std::map<std::pair<int, int>, std::size_t> rankOf; // (layer, value) to 1 + position in the list of segments
  for (std::size_t n = 0; n < segments.size(); ++n)
  {
    rankOf[{ segments[n].layer, segments[n].value }] = n + 1;
  }
  const std::size_t voxelCount = numbers.size() / layerCount;
  std::vector<std::size_t> winner(voxelCount, 0);
  for (std::size_t layer = 0; layer < layerCount; ++layer)
  {
    std::size_t rank = 0;
    int lastValue = 0;
    for (std::size_t voxel = 0; voxel < voxelCount; ++voxel)
    {
      const int value = numbers[layersFirst ? voxel * layerCount + layer : layer * voxelCount + voxel];
      if (value != lastValue)
      {
        const auto found = rankOf.find({ int(layer), value });
        if (value != 0 && found == rankOf.end())
        {
          throw Error("'" + path + "' holds " + std::to_string(value) + " in layer " + std::to_string(layer) +
                      ", which no segment of its header claims; save it again from the program that made it.");
        }
        rank = value == 0 ? 0 : found->second;
        lastValue = value;
      }
      winner[voxel] = std::max(winner[voxel], rank);
    }
  }
  std::vector<std::uint16_t> labels(voxelCount);
  std::transform(winner.begin(), winner.end(), labels.begin(), [&segments](std::size_t rank) {
    return rank == 0 ? std::uint16_t(0) : std::uint16_t(segments[rank - 1].label.id);
  });
  return labels;
}

} // namespace

LabelVolume readNrrd(const std::string& path)
{
  const NrrdPointer nrrd = loadNrrd(path);
  refuseFractions(*nrrd, path);
  const Axes axes = findAxes(*nrrd, path);
  const bool layered = axes.layers >= 0;
  const std::size_t layerCount = layered ? nrrd->axis[axes.layers].size : 1;

  LabelVolume volume;
  volume.placement = placementOf(*nrrd, axes, path);
  std::vector<Segment> segments = readSegments(*nrrd, layered);
  if (layerCount > 1 && segments.empty())
  {
    throw Error("'" + path + "' has more than three dimensions and no segments; choose one volume of it.");
  }

  LabelConversion conversion;
  conversion.path = path;
  conversion.size = volume.placement.size;
  conversion.valuesPerVoxel = axes.layers == 0 ? layerCount : 1;
  volume.voxels = readNumbers(*nrrd, conversion);
  if (layerCount > 1)
  {
    makeIdsUnique(segments);
    volume.voxels = flattenLayers(volume.voxels, layerCount, axes.layers == 0, segments, path);
  }
  for (Segment& segment : segments)
  {
    volume.labels.push_back(std::move(segment.label));
  }
  return volume;
}

} // namespace sono
