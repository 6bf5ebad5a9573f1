#include "ImageGroup.h"

#include "Cuda/DeviceImager.h"
#include "Echo/FormRf.h"
#include "Image/ScanConvert.h"
#include "Kernel/TracePath.h"
#include "Trace/TraceSetup.h"

#include <algorithm>
#include <string>

namespace sono {

void requireEachMeets(const TraceSetup& setup, std::size_t images)
{
  const CellSpace<NoTargets> space{ setup.region->view(), {} };
  const std::size_t perImage = setup.lines.size() / images;
  for (std::size_t image = 0; image < images; ++image)
  {
    const auto first = setup.lines.begin() + std::ptrdiff_t(image * perImage);
    PathState path;
    if (std::none_of(first, first + std::ptrdiff_t(perImage),
                     [&](const TraceLine& line) { return enterSpace(space, line, setup.view.depthMm, path); }))
    {
      throw Error("no scan line of pose " + std::to_string(image) +
                  " meets the label map: move the probe onto the skin or increase the depth");
    }
  }
}

int imagesThatFit(const ImageSettings& settings)
{
  const int lines = settings.geometry.totalLineCount();
  const TracedLines traced = tracedLayout(lines, settings.tracing);
  const RfLines rf = rfLayout(lines, settings.echo);
  const PlaneImage pixels = planeImageLayout(settings.geometry, settings.pixelMm);
  // Without what a single launch of the tracer needs.
  const double tones = settings.tracing.imagingMode == ImagingMode::Harmonic ? 2.0 : 1.0;
  const double bytesPerLine = tones * (32.0 * traced.echoCount + 20.0 * traced.binCount) + 48.0 * rf.sampleCount;
  return DeviceImager::instance().imagesThatFit(bytesPerLine * lines + 6.0 * pixels.width * pixels.height);
}

} // namespace sono
