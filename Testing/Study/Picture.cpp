#include "Picture.h"

#include "Core/Progress.h"
#include "Image/LabelSlice.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace sono::study {
namespace {

constexpr std::array<std::uint8_t, 3> outside{ 16, 20, 36 };
constexpr int gap = 4;

std::array<float, 3> colourOf(const LabelInfo& label)
{
  if (label.hasColor)
  {
    return label.color;
  }
  const float golden = 0.618034f * float(label.id);
  const float hue = 6.2831853f * (golden - std::floor(golden));
  return { 0.55f + 0.35f * std::cos(hue), 0.55f + 0.35f * std::cos(hue - 2.094f),
           0.55f + 0.35f * std::cos(hue + 2.094f) };
}

Picture blank(int width, int height)
{
  Picture picture{ width, height, {} };
  for (int i = 0; i < width * height; ++i)
  {
    picture.rgb.insert(picture.rgb.end(), outside.begin(), outside.end());
  }
  return picture;
}

OIIO::ImageBuf bufferOf(const Picture& picture)
{
  OIIO::ImageBuf buffer(OIIO::ImageSpec(picture.width, picture.height, 3, OIIO::TypeDesc::UINT8));
  buffer.set_pixels(OIIO::ROI::All(), OIIO::TypeDesc::UINT8, picture.rgb.data());
  return buffer;
}

} // namespace

Picture pictureOf(const PlaneImage& grey)
{
  Picture picture = blank(grey.width, grey.height);
  for (std::size_t i = 0; i < grey.value.size(); ++i)
  {
    if (grey.mask[i])
    {
      const auto level = std::uint8_t(std::lround(255.0f * std::clamp(grey.value[i], 0.0f, 1.0f)));
      std::fill_n(picture.rgb.begin() + std::ptrdiff_t(3 * i), 3, level);
    }
  }
  return picture;
}

Picture pictureOfLabels(const LabelVolume& labels, const ScanGeometry& geometry, const ProbePose& pose,
                        const PlaneImage& layout, const TracedLines& traced)
{
  const DepthOffsets offsets{ &traced.depthOffsetMm, traced.binCount, traced.binMm };
  const std::vector<std::uint16_t> ids = sliceLabels(labels, geometry, pose, layout, offsets);
  Picture picture = blank(layout.width, layout.height);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    const LabelInfo* label = layout.mask[i] ? labels.find(ids[i]) : nullptr;
    if (label)
    {
      const auto colour = colourOf(*label);
      for (std::size_t c = 0; c < 3; ++c)
      {
        picture.rgb[3 * i + c] = std::uint8_t(std::lround(255.0f * colour[c]));
      }
    }
  }
  return picture;
}

Picture montage(const std::vector<Picture>& panels, int columns)
{
  if (panels.empty() || columns < 1)
  {
    throw Error("a montage needs panels and columns: give it at least one of each");
  }
  std::vector<int> widths(std::size_t(std::min(columns, int(panels.size()))));
  int height = 0;
  for (std::size_t i = 0; i < panels.size(); ++i)
  {
    int& width = widths[i % std::size_t(columns)];
    width = std::max(width, panels[i].width);
    height = std::max(height, panels[i].height);
  }
  const int rows = (int(panels.size()) + columns - 1) / columns;
  const int width = std::accumulate(widths.begin(), widths.end(), gap * (int(widths.size()) - 1));
  OIIO::ImageBuf all = bufferOf(blank(width, rows * (height + gap) - gap));
  int left = 0;
  for (std::size_t i = 0; i < panels.size(); ++i)
  {
    const std::size_t column = i % std::size_t(columns);
    left = column == 0 ? 0 : left;
    const int x = left + (widths[column] - panels[i].width) / 2;
    const int y = int(i) / columns * (height + gap) + (height - panels[i].height) / 2;
    OIIO::ImageBufAlgo::paste(all, x, y, 0, 0, bufferOf(panels[i]));
    left += widths[column] + gap;
  }
  Picture picture{ all.spec().width, all.spec().height, {} };
  picture.rgb.resize(std::size_t(picture.width) * std::size_t(picture.height) * 3);
  all.get_pixels(OIIO::ROI::All(), OIIO::TypeDesc::UINT8, picture.rgb.data());
  return picture;
}

PlaneImage readGrey(const std::filesystem::path& path, double pixelMm, double lateralMinMm, double axialMinMm)
{
  const OIIO::ImageBuf buffer(path.string());
  PlaneImage image;
  image.width = buffer.spec().width;
  image.height = buffer.spec().height;
  image.pixelMm = pixelMm;
  image.lateralMinMm = lateralMinMm;
  image.axialMinMm = axialMinMm;
  const std::size_t count = std::size_t(image.width) * std::size_t(image.height);
  image.value.resize(count);
  image.mask.assign(count, 1);
  OIIO::ROI first = OIIO::get_roi(buffer.spec());
  first.chend = 1;
  if (!buffer.get_pixels(first, OIIO::TypeDesc::FLOAT, image.value.data()))
  {
    throw Error("cannot read '" + path.string() + "': " + buffer.geterror());
  }
  return image;
}

void writePicture(const Picture& picture, const std::filesystem::path& path)
{
  OIIO::ImageBuf buffer = bufferOf(picture);
  buffer.specmod().attribute("png:compressionLevel", 9);
  if (!buffer.write(path.string()))
  {
    throw Error("'" + path.string() + "' cannot be written: " + buffer.geterror());
  }
}

} // namespace sono::study
