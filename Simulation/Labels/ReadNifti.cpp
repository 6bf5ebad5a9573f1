#include "Labels/ReadNifti.h"

#include "Core/Progress.h"
#include "Labels/LabelConversion.h"

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

struct CloseFile
{
  void operator()(gzFile file) const { gzclose(file); }
};
using InputFile = std::unique_ptr<gzFile_s, CloseFile>;

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
  if (std::max({ image->nx, image->ny, image->nz }) > 65535 || std::uint64_t(image->nvox) > maxVoxels)
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

void appendNumbers(const LabelConversion& conversion, int datatype, const void* data, std::size_t count,
                   std::vector<std::uint16_t>& labels)
{
  switch (datatype)
  {
    case NIFTI_TYPE_UINT8:
      return conversion.append(labels, static_cast<const std::uint8_t*>(data), count);
    case NIFTI_TYPE_INT8:
      return conversion.append(labels, static_cast<const std::int8_t*>(data), count);
    case NIFTI_TYPE_UINT16:
      return conversion.append(labels, static_cast<const std::uint16_t*>(data), count);
    case NIFTI_TYPE_INT16:
      return conversion.append(labels, static_cast<const std::int16_t*>(data), count);
    case NIFTI_TYPE_UINT32:
      return conversion.append(labels, static_cast<const std::uint32_t*>(data), count);
    case NIFTI_TYPE_INT32:
      return conversion.append(labels, static_cast<const std::int32_t*>(data), count);
    case NIFTI_TYPE_UINT64:
      return conversion.append(labels, static_cast<const std::uint64_t*>(data), count);
    case NIFTI_TYPE_INT64:
      return conversion.append(labels, static_cast<const std::int64_t*>(data), count);
    case NIFTI_TYPE_FLOAT32:
      return conversion.append(labels, static_cast<const float*>(data), count);
    case NIFTI_TYPE_FLOAT64:
      return conversion.append(labels, static_cast<const double*>(data), count);
    default:
      throw Error("'" + conversion.path + "' has voxels of type " + nifti_datatype_string(datatype) +
                  "; a label map holds whole numbers 0..65535, convert it.");
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

/// Reads the voxels of one phase slice by slice. Not through libnifti, which turns NaN into 0 without a word.
std::vector<std::uint16_t> readVoxels(const nifti_image& image, const std::string& path, int phase)
{
  LabelConversion conversion;
  conversion.path = path;
  conversion.size = Vec3i(int(image.nx), int(image.ny), int(image.nz));
  if (image.scl_slope != 0.0)
  {
    conversion.slope = image.scl_slope;
    conversion.intercept = image.scl_inter;
  }
  std::vector<std::uint16_t> labels;
  appendNumbers(conversion, image.datatype, nullptr, 0, labels); // refuses other types before anything is read

  const std::string truncated =
    "cannot read '" + path + "': its voxel data end too early or are damaged; copy it again.";
  const InputFile file(gzopen(path.c_str(), "rb"));
  const std::int64_t phaseBytes = image.nx * image.ny * image.nz * image.nbyper;
  if (!file || gzseek(file.get(), z_off_t(image.iname_offset + phase * phaseBytes), SEEK_SET) < 0)
  {
    throw Error(truncated);
  }
  const std::size_t rowValues = std::size_t(image.nx);
  const std::size_t rows = std::size_t(image.ny) * std::size_t(image.nz);
  const unsigned rowBytes = unsigned(rowValues) * unsigned(image.nbyper);
  std::vector<char> row(rowBytes);
  labels.reserve(rowValues * rows);
  for (std::size_t n = 0; n < rows; ++n)
  {
    if (gzread(file.get(), row.data(), rowBytes) != int(rowBytes))
    {
      throw Error(truncated);
    }
    if (image.byteorder != nifti_short_order())
    {
      nifti_swap_Nbytes(std::int64_t(rowValues), image.swapsize, row.data());
    }
    appendNumbers(conversion, image.datatype, row.data(), rowValues, labels);
  }
  char next = 0;
  int status = Z_OK;
  gzread(file.get(), &next, 1); // only past the last byte does zlib compare the checksum
  gzerror(file.get(), &status);
  if (status != Z_OK)
  {
    throw Error(truncated);
  }
  return labels;
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

LabelVolume readNifti(const std::string& path, int phase)
{
  const Image image = readHeader(path);
  if (phase < 0 || phase >= std::max<std::int64_t>(image->nt, 1))
  {
    throw Error("'" + path + "' has " + std::to_string(std::max<std::int64_t>(image->nt, 1)) + " phases, so phase " +
                std::to_string(phase) + ", counted from 0, is not among them; choose another.");
  }
  LabelVolume volume;
  volume.placement = placementOf(*image, path);
  volume.voxels = readVoxels(*image, path, phase);
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
