#include "WritePicture.h"

#include <OpenImageIO/imageio.h>

#include <cstdio>

namespace {

OIIO::TypeDesc typeOf(sono::Picture::Number number)
{
  switch (number)
  {
    case sono::Picture::Number::UInt8:
      return OIIO::TypeDesc::UINT8;
    case sono::Picture::Number::UInt16:
      return OIIO::TypeDesc::UINT16;
    default:
      return OIIO::TypeDesc::FLOAT;
  }
}

/// Whether a file's numbers hold all that the picture's do. OpenEXR's half holds each of 256 greys, as a fraction of 1.
bool holds(OIIO::TypeDesc stored, OIIO::TypeDesc wanted)
{
  if (wanted.is_floating_point())
  {
    return stored == wanted;
  }
  return stored == wanted || stored.size() > wanted.size();
}

/// Fills a file that is open. Returns an empty text or what is wrong with it.
std::string fill(OIIO::ImageOutput& output, const sono::Picture& picture)
{
  const OIIO::TypeDesc type = typeOf(picture.number);
  const bool isHeld = holds(output.spec().format, type);
  // Also what is not: libpng complains of a file without pixels.
  if (!output.write_image(type, picture.pixels) || !output.close())
  {
    return output.geterror();
  }
  return isHeld ? std::string()
                : std::string("the format ") + output.format_name() + " cannot hold numbers of the type " +
                    type.c_str() + "; name a .tif file";
}

} // namespace

void sonoWritePicture(const std::string& path, const sono::Picture& picture, std::string& failure)
{
  OIIO::ImageSpec spec(picture.width, picture.height, picture.channels, typeOf(picture.number));
  spec.attribute("ResolutionUnit", "cm");
  spec.attribute("XResolution", static_cast<float>(10.0 / picture.pixelMm[0]));
  spec.attribute("YResolution", static_cast<float>(10.0 / picture.pixelMm[1]));
  spec.attribute("PixelAspectRatio", static_cast<float>(picture.pixelMm[0] / picture.pixelMm[1]));
  const auto output = OIIO::ImageOutput::create(path);
  if (!output)
  {
    failure = OIIO::geterror();
  }
  else if (!output->open(path, spec))
  {
    failure = output->geterror();
  }
  else
  {
    failure = fill(*output, picture);
    if (!failure.empty())
    {
      std::remove(path.c_str());
    }
  }
}
