#include "Files/DicomCine.h"

#include "Core/Error.h"
#include "Files/DicomHeader.h"
#include "Files/GreyFrames.h"

namespace sono {

namespace {

/// For the length of Pixel Data, which is even and has 32 bits, of which one value has another meaning.
constexpr double mostBytes = 4294967294.0;

void require(const std::string& path, const CineInfo& info)
{
  const auto refuse = [&](const std::string& why) { throw Error("cannot write '" + path + "': " + why + "."); };
  if (path.empty())
  {
    throw Error("no DICOM file is named; name one that ends in .dcm.");
  }
  if (info.timesS.empty() || info.width < 1 || info.height < 1)
  {
    refuse("there are no pictures; simulate one first");
  }
  if (info.width > 65535 || info.height > 65535)
  {
    refuse("a DICOM picture has up to 65535 rows and columns and this has " + sizeText(info.width, info.height) +
           "; make its pixels larger");
  }
  if (info.probe.geometry.isVolume())
  {
    refuse("the probe scans a volume, and a multi-frame file holds pictures of a plane; choose another scan kind");
  }
  if (double(info.width) * info.height * double(info.timesS.size()) > mostBytes)
  {
    refuse("its " + std::to_string(info.timesS.size()) + " pictures of " + sizeText(info.width, info.height) +
           " are more than the 4 GB that a DICOM file holds; write them as several, or with larger pixels");
  }
}

} // namespace

DicomCine::DicomCine(const std::string& path, const CineInfo& info)
{
  require(path, info);
  frames_ = std::make_unique<GreyFrames>(path, dicomHeader(info), info.width, info.height, info.timesS.size());
  const std::size_t bytes = std::size_t(info.width) * std::size_t(info.height) * info.timesS.size();
  padding_ = std::string(bytes % 2, '\0'); // an element's length is even
}

DicomCine::~DicomCine() = default;

void DicomCine::add(const std::uint8_t* grey, int width, int height)
{
  frames_->add(grey, width, height);
}

void DicomCine::finish()
{
  frames_->finish(padding_);
}

} // namespace sono
