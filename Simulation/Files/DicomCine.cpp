#include "Files/DicomCine.h"

#include "Core/Error.h"
#include "Core/WholeFile.h"
#include "Files/DicomHeader.h"

#include <ostream>

namespace sono {

namespace {

/// For the length of Pixel Data, which is even and has 32 bits, of which one value has another meaning.
constexpr double mostBytes = 4294967294.0;

std::string sizeText(int width, int height)
{
  return std::to_string(width) + " x " + std::to_string(height) + " pixels";
}

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

struct DicomCine::State
{
  std::string path;
  int width;
  int height;
  std::size_t count;
  WholeFile file;
  std::size_t added = 0;

  [[noreturn]] void refuse(const std::string& why) const { throw Error("cannot write '" + path + "': " + why + "."); }
  void requireRoom(bool ok) const
  {
    if (!ok)
    {
      refuse("its folder is missing or protected or the disk is full; make room, or choose another folder");
    }
  }
};

DicomCine::DicomCine(const std::string& path, const CineInfo& info)
{
  require(path, info);
  const std::string header = dicomHeader(info);
  state_.reset(new State{ path, info.width, info.height, info.timesS.size(), WholeFile(path) });
  state_->file.stream().write(header.data(), std::streamsize(header.size()));
  state_->requireRoom(bool(state_->file.stream()));
}

DicomCine::~DicomCine() = default;

void DicomCine::add(const std::uint8_t* grey, int width, int height)
{
  State& state = *state_;
  const std::string number = "picture " + std::to_string(state.added + 1);
  if (width != state.width || height != state.height)
  {
    state.refuse(number + " has " + sizeText(width, height) + " and the first " + sizeText(state.width, state.height) +
                 "; keep the probe's depth, its sector and the pixel's size the same in all");
  }
  if (state.added == state.count)
  {
    state.refuse(number + " is one more than the " + std::to_string(state.count) + " that were announced");
  }
  ++state.added;
  state.file.stream().write(reinterpret_cast<const char*>(grey), std::streamsize(width) * height);
  state.requireRoom(bool(state.file.stream()));
}

void DicomCine::finish()
{
  State& state = *state_;
  if (state.added < state.count)
  {
    state.refuse("it has " + std::to_string(state.added) + " pictures of " + std::to_string(state.count));
  }
  if (std::size_t(state.width) * std::size_t(state.height) * state.count % 2 != 0)
  {
    state.file.stream().put('\0'); // an element's length is even
  }
  state.requireRoom(state.file.finish());
}

} // namespace sono
