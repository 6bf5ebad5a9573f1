#include "Labels/ReadNrrd.h"

#include "Core/Progress.h"
#include "Labels/CsvFile.h"
#include "Labels/LabelCode.h"
#include "Labels/LabelConversion.h"
#include "Labels/NrrdFile.h"
#include "Labels/VoxelFile.h"
#include "Labels/VoxelRuns.h"

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

NumberType numberTypeOf(const Nrrd& nrrd)
{
  switch (nrrd.type)
  {
    case nrrdTypeChar:
      return NumberType::Int8;
    case nrrdTypeUChar:
      return NumberType::UInt8;
    case nrrdTypeShort:
      return NumberType::Int16;
    case nrrdTypeUShort:
      return NumberType::UInt16;
    case nrrdTypeInt:
      return NumberType::Int32;
    case nrrdTypeUInt:
      return NumberType::UInt32;
    case nrrdTypeLLong:
      return NumberType::Int64;
    case nrrdTypeULLong:
      return NumberType::UInt64;
    case nrrdTypeFloat:
      return NumberType::Float32;
    default:
      return NumberType::Float64; // openNrrdFile has refused what is no number
  }
}

void refuseColours(const Nrrd& nrrd, const Axes& axes, const std::string& path)
{
  const int kind = axes.layers < 0 ? int(nrrdKindUnknown) : nrrd.axis[axes.layers].kind;
  if (kind == nrrdKindRGBColor || kind == nrrdKindRGBAColor || kind == nrrdKind3Color || kind == nrrdKind4Color ||
      kind == nrrdKindHSVColor || kind == nrrdKindXYZColor)
  {
    throw Error("'" + path + "' is a colour image (" + airEnumStr(nrrdKind, kind) +
                "); choose the segmentation or scan that it was painted from.");
  }
}

VoxelFile voxelsOf(NrrdFile& file, const std::string& path)
{
  const Axes axes = findAxes(*file.header, path);
  refuseColours(*file.header, axes, path);
  const std::size_t layers = axes.layers >= 0 ? file.header->axis[axes.layers].size : 1;
  return { path,
           placementOf(*file.header, axes, path),
           numberTypeOf(*file.header),
           file.swapped,
           1.0,
           0.0,
           layers,
           axes.layers == 0,
           std::move(file.data) };
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

/// Collects the voxels of a layer's segments.
class LayerRuns
{
public:
  LayerRuns(std::size_t layer, const std::vector<Segment>& segments, std::vector<Structure>& structures,
            const std::string& path)
    : layer_(layer)
    , path_(path)
  {
    for (std::size_t n = 0; n < segments.size(); ++n)
    {
      if (std::size_t(segments[n].layer) == layer)
      {
        voxelsOf_[segments[n].value] = &structures[n].voxels;
      }
    }
  }

  void add(std::uint16_t value, std::size_t voxel, std::size_t count)
  {
    if (value == 0)
    {
      return;
    }
    if (value != value_)
    {
      const auto found = voxelsOf_.find(value);
      if (found == voxelsOf_.end())
      {
        throw Error("'" + path_ + "' holds " + std::to_string(value) + " in layer " + std::to_string(layer_) +
                    ", which no segment of its header claims; save it again from the program that made it.");
      }
      value_ = value;
      voxels_ = found->second;
    }
    voxels_->add(voxel, count);
  }

private:
  std::size_t layer_;
  std::string path_;
  std::map<int, VoxelRuns*> voxelsOf_;
  std::uint16_t value_ = 0; // of `voxels_`
  VoxelRuns* voxels_ = nullptr;
};

void readLayers(VoxelFile& file, const std::vector<Segment>& segments, LabelVolume& volume, const Progress& progress)
{
  std::vector<Structure> structures(segments.size());
  for (std::size_t n = 0; n < segments.size(); ++n)
  {
    structures[n].label = std::uint16_t(segments[n].label.id);
    structures[n].name = segments[n].label.name;
  }
  const LabelConversion conversion(file);
  std::map<std::size_t, LayerRuns> layers; // as they are met: a header may promise any number
  const auto layer = [&](std::size_t n) -> LayerRuns& {
    return layers.try_emplace(n, n, segments, structures, file.path).first->second;
  };
  const std::size_t voxelCount = file.placement.voxelCount();
  std::vector<std::uint16_t> values;
  readNumbers(file, progress, [&](const auto* numbers, std::size_t count, std::size_t position) {
    values.resize(count);
    conversion.convert(numbers, count, position, values.data());
    for (std::size_t n = 0; n < count;)
    {
      const std::size_t at = position + n;
      if (file.layersFirst)
      {
        if (values[n] != 0)
        {
          layer(at % file.layers).add(values[n], at / file.layers, 1);
        }
        ++n;
        continue;
      }
      const std::size_t voxel = at % voxelCount;
      const std::size_t last = n + std::min(count - n, voxelCount - voxel);
      const std::size_t begin = n;
      n = std::size_t(std::find_if(values.begin() + std::ptrdiff_t(n), values.begin() + std::ptrdiff_t(last),
                                   [&](std::uint16_t value) { return value != values[begin]; }) -
                      values.begin());
      if (values[begin] != 0)
      {
        layer(at / voxelCount).add(values[begin], voxel, n - begin);
      }
    }
  });
  FlattenedStructures flat = flattenStructures(structures, voxelCount, "'" + file.path + "'");
  volume.voxels = std::move(flat.voxels);
  volume.notice = std::move(flat.overlap);
}

} // namespace

VoxelFile openNrrd(const std::string& path)
{
  NrrdFile nrrd = openNrrdFile(path);
  return voxelsOf(nrrd, path);
}

LabelVolume readNrrd(const std::string& path, const Progress& progress)
{
  NrrdFile nrrd = openNrrdFile(path);
  refuseFractions(*nrrd.header, path);
  VoxelFile file = voxelsOf(nrrd, path);
  const bool layered = file.layers > 1 || nrrd.header->dim > 3;

  LabelVolume volume;
  volume.placement = file.placement;
  std::vector<Segment> segments = readSegments(*nrrd.header, layered);
  if (file.layers > 1 && segments.empty())
  {
    throw Error("'" + path + "' has more than three dimensions and no segments; choose one volume of it.");
  }
  if (file.layers > 1)
  {
    makeIdsUnique(segments);
    readLayers(file, segments, volume, progress);
  }
  else
  {
    volume.voxels = readLabelNumbers(file, progress);
  }
  for (Segment& segment : segments)
  {
    volume.labels.push_back(std::move(segment.label));
  }
  return volume;
}

} // namespace sono
