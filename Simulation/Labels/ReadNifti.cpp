#include "Labels/ReadNifti.h"

#include "Core/Progress.h"
#include "Labels/LabelConversion.h"
#include "Labels/VoxelFile.h"

#include <nifti/nifti2_io.h>
#include <zlib.h>

#include <algorithm>
#include <memory>

namespace sono {

namespace {

constexpr std::uint64_t maxVoxels = std::uint64_t(1) << 32;

struct FreeImage
{
  void operator()(nifti_image* image) const { nifti_image_free(image); }
};
using Image = std::unique_ptr<nifti_image, FreeImage>;

/// libnifti turns a dimension of 0 into 1, so the header is looked at as it stands.
void refuseEmptyImage(const std::string& path)
{
  int version = -1;
  const std::unique_ptr<void, void (*)(void*)> header(nifti_read_header(path.c_str(), &version, 0), std::free);
  if (!header)
  {
    return; // nifti_image_read will say so
  }
  for (int axis = 1; axis <= 3; ++axis)
  {
    const auto* nifti1 = static_cast<const nifti_1_header*>(header.get());
    const auto* nifti2 = static_cast<const nifti_2_header*>(header.get());
    const std::int64_t axes = version == 2 ? nifti2->dim[0] : nifti1->dim[0];
    const std::int64_t extent = version == 2 ? nifti2->dim[axis] : nifti1->dim[axis];
    if (axis <= axes && extent <= 0)
    {
      throw Error("'" + path + "' has no voxels (its axis " + std::to_string(axis) + " has the length " +
                  std::to_string(extent) + "); choose an image with at least one voxel along each axis.");
    }
  }
}

Image readHeader(const std::string& path)
{
  nifti_set_debug_level(0);
  refuseEmptyImage(path);
  Image image(nifti_image_read(path.c_str(), 0));
  if (!image)
  {
    throw Error("cannot read '" + path + "': it is not a NIfTI file, or its header is damaged.");
  }
  if (image->nu > 1 || image->nv > 1 || image->nw > 1)
  {
    throw Error("'" + path + "' has more than three dimensions and time; choose one volume of it.");
  }
  const bool isLong = std::max({ image->nx, image->ny, image->nz, image->nt }) > 65535;
  if (isLong || std::uint64_t(image->nx) * std::uint64_t(image->ny) * std::uint64_t(image->nz) > maxVoxels)
  {
    throw Error("'" + path + "' claims " + std::to_string(image->nx) + " x " + std::to_string(image->ny) + " x " +
                std::to_string(image->nz) + " voxels, which is more than a label map may have; check its header.");
  }
  return image;
}

double millimetresPerUnit(const nifti_image& image)
{
  switch (image.xyz_units)
  {
    case NIFTI_UNITS_METER:
      return 1000.0;
    case NIFTI_UNITS_MICRON:
      return 0.001;
    default:
      return 1.0;
  }
}

/// NIfTI's world is RAS, ours is LPS: x and y change sign. This is the one place where NIfTI's frame is changed.
GridPlacement placementOf(const nifti_image& image, const std::string& path)
{
  const Vec3i size(int(image.nx), int(image.ny), int(image.nz));
  const double unit = millimetresPerUnit(image);
  if (image.sform_code <= 0 && image.qform_code <= 0)
  {
    Mat3d columns(0.0);
    columns[0][0] = unit * image.dx;
    columns[1][1] = unit * (image.ndim < 2 ? 1.0 : image.dy);
    columns[2][2] = unit * (image.ndim < 3 ? 1.0 : image.dz);
    return placementFromAffine(size, columns, Vec3d(0.0), path);
  }
  const nifti_dmat44& affine = image.sform_code > 0 ? image.sto_xyz : image.qto_xyz;
  Mat3d columns(0.0);
  Vec3d origin(0.0);
  for (int row = 0; row < 3; ++row)
  {
    const double sign = row < 2 ? -unit : unit;
    for (int column = 0; column < 3; ++column)
    {
      columns[column][row] = sign * affine.m[row][column];
    }
    origin[row] = sign * affine.m[row][3];
  }
  return placementFromAffine(size, columns, origin, path);
}

NumberType numberTypeOf(const nifti_image& image, const std::string& path)
{
  switch (image.datatype)
  {
    case NIFTI_TYPE_UINT8:
      return NumberType::UInt8;
    case NIFTI_TYPE_INT8:
      return NumberType::Int8;
    case NIFTI_TYPE_UINT16:
      return NumberType::UInt16;
    case NIFTI_TYPE_INT16:
      return NumberType::Int16;
    case NIFTI_TYPE_UINT32:
      return NumberType::UInt32;
    case NIFTI_TYPE_INT32:
      return NumberType::Int32;
    case NIFTI_TYPE_UINT64:
      return NumberType::UInt64;
    case NIFTI_TYPE_INT64:
      return NumberType::Int64;
    case NIFTI_TYPE_FLOAT32:
      return NumberType::Float32;
    case NIFTI_TYPE_FLOAT64:
      return NumberType::Float64;
    case NIFTI_TYPE_RGB24:
    case NIFTI_TYPE_RGBA32:
      throw Error("'" + path + "' is a colour image (" + nifti_datatype_string(image.datatype) +
                  "); choose the segmentation or scan that it was painted from.");
    default:
      throw Error("'" + path + "' has voxels of type " + nifti_datatype_string(image.datatype) +
                  "; convert it to whole numbers or floats.");
  }
}

double secondsPerUnit(const nifti_image& image)
{
  switch (image.time_units)
  {
    case NIFTI_UNITS_MSEC:
      return 1e-3;
    case NIFTI_UNITS_USEC:
      return 1e-6;
    default:
      return 1.0;
  }
}

/// The numbers of one phase. Not through libnifti, which turns NaN into 0 without a word.
VoxelFile voxelsOf(const nifti_image& image, const std::string& path, int phase)
{
  const std::int64_t phases = std::max<std::int64_t>(image.nt, 1);
  if (phase < 0 || phase >= phases)
  {
    throw Error("'" + path + "' has " + std::to_string(phases) + " phases, so phase " + std::to_string(phase) +
                ", counted from 0, is not among them; choose another.");
  }
  const NumberType type = numberTypeOf(image, path);
  const GridPlacement placement = placementOf(image, path);
  const ByteStream::Packing packing = isGzip(path) ? ByteStream::Packing::Deflate : ByteStream::Packing::None;
  ByteStream bytes(path, 0, packing, path);
  const std::uint64_t phaseBytes = std::uint64_t(placement.voxelCount()) * bytesOf(type);
  if (image.iname_offset < 0)
  {
    throw Error("cannot read '" + path + "': its header says that the voxels begin before the file; correct it.");
  }
  bytes.skip(std::uint64_t(image.iname_offset) + std::uint64_t(phase) * phaseBytes);
  const bool scaled = image.scl_slope != 0.0;
  return { path,
           placement,
           type,
           image.byteorder != nifti_short_order(),
           scaled ? double(image.scl_slope) : 1.0,
           scaled ? double(image.scl_inter) : 0.0,
           1,
           false,
           std::move(bytes) };
}

Image makeImage(const std::string& path, const LabelVolume& volume)
{
  const GridPlacement& grid = volume.placement;
  const std::int64_t dims[8] = { 3, grid.size.x, grid.size.y, grid.size.z, 1, 1, 1, 1 };
  Image image(nifti_make_new_nim(dims, NIFTI_TYPE_UINT16, 0));
  if (!image)
  {
    throw Error("cannot write '" + path + "': a NIfTI header could not be made.");
  }
  nifti_dmat44 affine{};
  affine.m[3][3] = 1.0;
  for (int row = 0; row < 3; ++row)
  {
    const double sign = row < 2 ? -1.0 : 1.0;
    for (int column = 0; column < 3; ++column)
    {
      affine.m[row][column] = sign * grid.direction[column][row] * grid.spacingMm[column];
    }
    affine.m[row][3] = sign * grid.originMm[row];
  }
  image->sto_xyz = affine;
  image->sform_code = NIFTI_XFORM_SCANNER_ANAT;
  image->qform_code = NIFTI_XFORM_SCANNER_ANAT;
  nifti_dmat44_to_quatern(affine, &image->quatern_b, &image->quatern_c, &image->quatern_d, &image->qoffset_x,
                          &image->qoffset_y, &image->qoffset_z, &image->dx, &image->dy, &image->dz, &image->qfac);
  std::copy_n(&image->dx, 3, image->pixdim + 1);
  image->pixdim[0] = image->qfac;
  image->xyz_units = NIFTI_UNITS_MM;
  image->intent_code = NIFTI_INTENT_LABEL;
  image->nifti_type = NIFTI_FTYPE_NIFTI1_1;
  nifti_set_iname_offset(image.get(), 1);
  return image;
}

bool writeBytes(gzFile file, const void* data, std::size_t bytes)
{
  const char* at = static_cast<const char*>(data);
  constexpr std::size_t chunk = std::size_t(1) << 26;
  for (std::size_t done = 0; done < bytes; done += chunk)
  {
    const unsigned count = unsigned(std::min(chunk, bytes - done));
    if (gzwrite(file, at + done, count) != int(count))
    {
      return false;
    }
  }
  return true;
}

} // namespace

LabelPhases readNiftiPhases(const std::string& path)
{
  const Image image = readHeader(path);
  const double stepS = image->dt * secondsPerUnit(*image);
  return { int(std::max<std::int64_t>(image->nt, 1)), stepS > 0.0 ? stepS : 1.0 };
}

VoxelFile openNifti(const std::string& path, int phase)
{
  return voxelsOf(*readHeader(path), path, phase);
}

LabelVolume readNifti(const std::string& path, int phase, const Progress& progress)
{
  const Image image = readHeader(path);
  VoxelFile file = voxelsOf(*image, path, phase);
  LabelVolume volume;
  volume.placement = file.placement;
  volume.voxels = readLabelNumbers(file, progress);
  for (int n = 0; n < image->num_ext; ++n)
  {
    const nifti1_extension& extension = image->ext_list[n];
    const std::size_t bytes = std::size_t(std::max(extension.esize - 8, 0)); // esize counts its own 8 bytes
    for (LabelInfo& label : labelsFromXml(std::string(extension.edata, bytes)))
    {
      volume.labels.push_back(std::move(label));
    }
  }
  return volume;
}

void writeNifti(const std::string& path, const LabelVolume& volume)
{
  nifti_set_debug_level(0);
  const Vec3i size = volume.placement.size;
  if (std::max({ size.x, size.y, size.z }) > 32767)
  {
    throw Error("cannot write '" + path + "': NIfTI-1 holds at most 32767 voxels along an axis; crop the volume.");
  }
  const Image image = makeImage(path, volume);
  nifti_1_header header{};
  const bool compressed = path.size() > 3 && path.compare(path.size() - 3, 3, ".gz") == 0;
  const gzFile file = gzopen(path.c_str(), compressed ? "wb6" : "wbT");
  if (!file)
  {
    throw Error("cannot write '" + path + "': the folder is missing or may not be written to.");
  }
  const char noExtension[4] = { 0, 0, 0, 0 };
  bool written = nifti_convert_nim2n1hdr(image.get(), &header) == 0;
  written = written && writeBytes(file, &header, sizeof(header)) && writeBytes(file, noExtension, 4);
  written = written && writeBytes(file, volume.voxels.data(), volume.voxels.size() * sizeof(std::uint16_t));
  if (gzclose(file) != Z_OK || !written)
  {
    throw Error("cannot write '" + path + "': the disk may be full.");
  }
}

} // namespace sono
