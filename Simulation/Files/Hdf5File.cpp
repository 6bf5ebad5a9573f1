#include "Files/Hdf5File.h"

#include "Core/Error.h"

#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>

namespace sono {

namespace {

/// HDF5 prints what fails, unless it is asked not to; what other parts of the process asked for comes back.
class Quiet
{
public:
  Quiet()
  {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

/// A handle of HDF5 and the function that closes it.
class Handle
{
public:
  Handle(hid_t id, herr_t (*close)(hid_t))
    : id_(id)
    , close_(close)
  {
  }
  ~Handle()
  {
    if (id_ >= 0)
    {
      close_(id_);
    }
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

Handle spaceOf(const Hdf5File::Shape& shape)
{
  const std::vector<hsize_t> sizes(shape.begin(), shape.end());
  return { sizes.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(int(sizes.size()), sizes.data(), nullptr),
           H5Sclose };
}

/// So that a path makes the groups on its way.
Handle groupsOnTheWay()
{
  const hid_t id = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(id, 1);
  return { id, H5Pclose };
}

/// UTF-8 of any length.
Handle textType()
{
  const hid_t id = H5Tcopy(H5T_C_S1);
  H5Tset_size(id, H5T_VARIABLE);
  H5Tset_cset(id, H5T_CSET_UTF8);
  return { id, H5Tclose };
}

bool write(hid_t file, const std::string& name, hid_t type, const Hdf5File::Shape& shape, const void* values)
{
  const Handle set(H5Dcreate2(file, name.c_str(), type, spaceOf(shape), groupsOnTheWay(), H5P_DEFAULT, H5P_DEFAULT),
                   H5Dclose);
  return set >= 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
}

bool writeAttribute(hid_t file, const std::string& name, const std::string& key, hid_t type,
                    const Hdf5File::Shape& shape, const void* values)
{
  const Handle object(H5Oopen(file, name.c_str(), H5P_DEFAULT), H5Oclose);
  const Handle attribute(H5Acreate2(object, key.c_str(), type, spaceOf(shape), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute >= 0 && H5Awrite(attribute, type, values) >= 0;
}

/// Whether a file may become so long, which it is not then.
bool hasRoom(const std::string& path, std::uint64_t bytes)
{
  const int file = open(path.c_str(), O_WRONLY);
  const bool has = file >= 0 && posix_fallocate(file, 0, off_t(bytes)) == 0;
  const bool isEmpty = file >= 0 && ftruncate(file, 0) == 0;
  return file >= 0 && close(file) == 0 && has && isEmpty;
}

} // namespace

Hdf5File::Hdf5File(const std::string& path, std::uint64_t floatCount)
  : path_(path)
  , whole_(path)
{
  const Quiet quiet;
  constexpr std::uint64_t headerBytes = 1 << 20;
  require(bool(whole_.stream()) && hasRoom(whole_.partPath(), headerBytes + floatCount * sizeof(float)));
  // Of 1.10, so that any reader of these years takes it.
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_V110);
  file_ = H5Fcreate(whole_.partPath().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  require(file_ >= 0);
}

Hdf5File::~Hdf5File()
{
  const Quiet quiet;
  if (file_ >= 0)
  {
    H5Fclose(file_);
  }
}

void Hdf5File::refuse() const
{
  throw Error("cannot write '" + path_ +
              "': its folder is missing or protected or the disk is full; make room, or choose another folder.");
}

void Hdf5File::require(bool ok) const
{
  if (!ok)
  {
    refuse();
  }
}

void Hdf5File::group(const std::string& name)
{
  const Quiet quiet;
  const Handle made(H5Gcreate2(file_, name.c_str(), groupsOnTheWay(), H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  require(made >= 0);
}

void Hdf5File::floats(const std::string& name, const Shape& shape, const std::vector<float>& values)
{
  const Quiet quiet;
  require(write(file_, name, H5T_NATIVE_FLOAT, shape, values.data()));
}

void Hdf5File::text(const std::string& name, const std::string& value)
{
  const Quiet quiet;
  const char* characters = value.c_str();
  require(write(file_, name, textType(), {}, &characters));
}

void Hdf5File::texts(const std::string& name, const std::vector<std::string>& values)
{
  const Quiet quiet;
  std::vector<const char*> characters;
  for (const std::string& value : values)
  {
    characters.push_back(value.c_str());
  }
  require(write(file_, name, textType(), { values.size() }, characters.data()));
}

void Hdf5File::codes(const std::string& name, const std::string& value)
{
  const Quiet quiet;
  const std::vector<std::uint16_t> numbers(value.begin(), value.end());
  require(write(file_, name, H5T_NATIVE_UINT16, { numbers.size(), 1 }, numbers.data()));
}

void Hdf5File::announce(const std::string& name, const Shape& shape)
{
  const Quiet quiet;
  std::vector<hsize_t> chunk(shape.begin(), shape.end());
  chunk.front() = 1;
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(creation, int(chunk.size()), chunk.data());
  H5Pset_shuffle(creation);
  H5Pset_deflate(creation, 1);
  const Handle set(
    H5Dcreate2(file_, name.c_str(), H5T_NATIVE_FLOAT, spaceOf(shape), groupsOnTheWay(), creation, H5P_DEFAULT),
    H5Dclose);
  require(set >= 0);
}

void Hdf5File::part(const std::string& name, std::uint64_t index, const std::vector<float>& values)
{
  const Quiet quiet;
  const Handle set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle all(H5Dget_space(set), H5Sclose);
  std::vector<hsize_t> size(std::size_t(H5Sget_simple_extent_ndims(all)));
  H5Sget_simple_extent_dims(all, size.data(), nullptr);
  std::vector<hsize_t> start(size.size(), 0);
  start.front() = index;
  size.front() = 1;
  H5Sselect_hyperslab(all, H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr);
  const Handle memory(H5Screate_simple(int(size.size()), size.data(), nullptr), H5Sclose);
  require(H5Dwrite(set, H5T_NATIVE_FLOAT, memory, all, H5P_DEFAULT, values.data()) >= 0);
}

void Hdf5File::attribute(const std::string& name, const std::string& key, const std::string& value)
{
  const Quiet quiet;
  const char* characters = value.c_str();
  require(writeAttribute(file_, name, key, textType(), {}, &characters));
}

void Hdf5File::numbers(const std::string& name, const std::string& key, const std::vector<std::int32_t>& values)
{
  const Quiet quiet;
  require(writeAttribute(file_, name, key, H5T_NATIVE_INT32, { values.size() }, values.data()));
}

void Hdf5File::finish()
{
  const Quiet quiet;
  const bool isWritten = H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0;
  const bool isClosed = H5Fclose(file_) >= 0;
  file_ = -1;
  require(isWritten && isClosed && whole_.finish());
}

} // namespace sono
