#include "SonoPicture.h"

#include "Core/Progress.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"

#include <dlfcn.h>
#include <filesystem>

namespace sono {
namespace {

Picture::Number numberOf(vtkDataArray* array, const std::string& name)
{
  switch (array->GetDataType())
  {
    case VTK_UNSIGNED_CHAR:
      return Picture::Number::UInt8;
    case VTK_UNSIGNED_SHORT:
      return Picture::Number::UInt16;
    case VTK_FLOAT:
      return Picture::Number::Float;
    default:
      throw Error("The array '" + name + "' is of the type " + array->GetDataTypeAsString() +
                  "; a picture holds unsigned char, unsigned short or float.");
  }
}

/// A function of the library that lies beside this one, which brings OpenImageIO.
template<class Function>
Function* load(const char* name)
{
  Dl_info self{};
  dladdr(reinterpret_cast<const void*>(&writePicture), &self);
  const std::string path = std::filesystem::path(self.dli_fname).replace_filename("libsonoPictures.so").string();
  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* function = library ? dlsym(library, name) : nullptr;
  if (!function)
  {
    throw Error(
      std::string("The library that writes pictures cannot be used; install SonoVDB again with OpenImageIO: ") +
      dlerror() + ".");
  }
  return reinterpret_cast<Function*>(function);
}

} // namespace

Picture pictureOf(vtkImageData* image, vtkDataArray* array)
{
  const std::string name = array->GetName() ? array->GetName() : "";
  Picture picture;
  int size[3];
  image->GetDimensions(size);
  if (size[2] != 1)
  {
    throw Error("The image has " + std::to_string(size[2]) +
                " slices and a picture has one; take a slice of it first.");
  }
  picture.width = size[0];
  picture.height = size[1];
  picture.channels = array->GetNumberOfComponents();
  if (picture.channels != 1 && picture.channels != 3 && picture.channels != 4)
  {
    throw Error("The array '" + name + "' has " + std::to_string(picture.channels) +
                " components; a picture has 1, 3 or 4.");
  }
  picture.number = numberOf(array, name);
  picture.pixels = array->GetVoidPointer(0);
  picture.pixelMm[0] = image->GetSpacing()[0];
  picture.pixelMm[1] = image->GetSpacing()[1];
  return picture;
}

void writePicture(const std::string& path, const Picture& picture)
{
  static const auto write = load<decltype(sonoWritePicture)>("sonoWritePicture");
  std::string failure;
  write(path, picture, failure);
  if (!failure.empty())
  {
    throw Error("cannot write '" + path + "': " + failure + ".");
  }
}

std::string openExrBytes(const ChannelImage& image)
{
  static const auto encode = load<decltype(sonoOpenExrBytes)>("sonoOpenExrBytes");
  std::string bytes;
  std::string failure;
  encode(image, bytes, failure);
  if (!failure.empty())
  {
    throw Error("cannot make an OpenEXR file: " + failure + ".");
  }
  return bytes;
}

} // namespace sono
