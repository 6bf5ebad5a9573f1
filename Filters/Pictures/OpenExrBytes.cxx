#include "OpenExrBytes.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <vector>

namespace {

OIIO::ImageSpec specOf(const sono::ChannelImage& image)
{
  OIIO::ImageSpec spec(image.width, image.height, int(image.names.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames = image.names;
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "2000:01:01 00:00:00"); // without one, OpenImageIO says when it was written
  for (const auto& [name, value] : image.numbers)
  {
    spec.attribute(name, float(value));
  }
  for (const auto& [name, text] : image.texts)
  {
    spec.attribute(name, text);
  }
  return spec;
}

/// Pixel by pixel.
std::vector<float> interleaved(const sono::ChannelImage& image)
{
  const std::size_t channels = image.values.size();
  std::vector<float> pixels(channels * std::size_t(image.width) * std::size_t(image.height));
  for (std::size_t channel = 0; channel < channels; ++channel)
  {
    float* pixel = pixels.data() + channel;
    for (const float value : image.values[channel])
    {
      *pixel = value;
      pixel += channels;
    }
  }
  return pixels;
}

} // namespace

void sonoOpenExrBytes(const sono::ChannelImage& image, std::string& bytes, std::string& failure)
{
  OIIO::Filesystem::IOVecOutput memory;
  const auto output = OIIO::ImageOutput::create("exr");
  if (!output)
  {
    failure = OIIO::geterror();
  }
  else if (!output->set_ioproxy(&memory) || !output->open("memory.exr", specOf(image)) ||
           !output->write_image(OIIO::TypeDesc::FLOAT, interleaved(image).data()) || !output->close())
  {
    failure = output->geterror();
  }
  else
  {
    bytes.assign(memory.buffer().begin(), memory.buffer().end());
    failure.clear();
  }
}
