#include "Files/DicomMasks.h"

#include "Core/WholeFile.h"
#include "Files/DicomMaskHeader.h"

#include <algorithm>
#include <limits>
#include <set>

namespace sono {

namespace {

constexpr double mostBytes = 4294967294.0; // as for any Pixel Data

/// A file for what is not yet whole; it has no name, and goes with the program.
std::fstream namelessFile(const std::string& path)
{
  const WholeFile named(path); // for a name that no other process takes
  std::fstream file(named.partPath(), std::ios::in | std::ios::out | std::ios::binary | std::ios::trunc);
  return file;
}

} // namespace

DicomMasks::DicomMasks(const std::string& path, const CineInfo& cine, const std::vector<ProbePose>& poses,
                       const std::vector<LabelInfo>& labels)
  : path_(path)
  , cine_(cine)
  , poses_(poses)
  , labels_(labels)
  , tally_(path, cine.width, cine.height, cine.timesS.size())
  , bits_(namelessFile(path))
{
  tally_.requireRoom(bits_.is_open());
  if (poses.size() != cine.timesS.size())
  {
    tally_.refuse("there are " + std::to_string(poses.size()) + " poses for " + std::to_string(cine.timesS.size()) +
                  " pictures; give as many");
  }
}

void DicomMasks::addBits(const std::uint16_t* labels, const std::set<std::uint16_t>& shown)
{
  const std::size_t count = std::size_t(cine_.width) * std::size_t(cine_.height);
  // A frame a label, one behind the other, the first pixel in the lowest bit (PS3.5 8.1.1).
  bytes_.assign((lastBits_ + shown.size() * count + 7) / 8, 0);
  bytes_.front() = lastByte_;
  std::vector<std::size_t> firstBit(std::numeric_limits<std::uint16_t>::max() + 1);
  std::size_t end = lastBits_;
  for (const std::uint16_t label : shown)
  {
    firstBit[label] = end;
    end += count;
  }
  for (std::size_t n = 0; n < count; ++n)
  {
    if (labels[n] != 0)
    {
      const std::size_t bit = firstBit[labels[n]] + n;
      bytes_[bit / 8] = std::uint8_t(bytes_[bit / 8] | 1u << bit % 8);
    }
  }
  lastBits_ = end % 8;
  lastByte_ = lastBits_ > 0 ? bytes_.back() : 0;
  bits_.write(reinterpret_cast<const char*>(bytes_.data()), std::streamsize(end / 8));
  tally_.requireRoom(bool(bits_));
}

void DicomMasks::add(const std::uint16_t* labels, int width, int height)
{
  tally_.add(width, height);
  const std::size_t count = std::size_t(width) * std::size_t(height);
  std::set<std::uint16_t> shown;
  std::uint16_t last = 0;
  for (std::size_t n = 0; n < count; ++n)
  {
    if (labels[n] != last)
    {
      last = labels[n];
      shown.insert(last);
    }
  }
  shown.erase(0);
  if (shown.empty())
  {
    return;
  }
  if (double(frames_.size() + shown.size()) * double(count) / 8.0 > mostBytes)
  {
    tally_.refuse("the masks are more than the 4 GB that a DICOM file holds; write fewer pictures, or larger pixels");
  }
  for (const std::uint16_t label : shown)
  {
    frames_.push_back({ tally_.added() - 1, label });
  }
  addBits(labels, shown);
}

void DicomMasks::finish()
{
  tally_.requireAll();
  if (frames_.empty())
  {
    tally_.refuse("no pixel shows a label; hold the probe to the body, or switch the label masks off");
  }
  std::set<int> shown;
  for (const Frame& frame : frames_)
  {
    shown.insert(frame.label);
  }
  std::vector<LabelInfo> segments;
  for (const int id : shown)
  {
    const auto known =
      std::find_if(labels_.begin(), labels_.end(), [id](const LabelInfo& label) { return label.id == id; });
    segments.push_back(known == labels_.end() ? LabelInfo() : *known);
    segments.back().id = id;
  }
  if (lastBits_ > 0)
  {
    bits_.put(char(lastByte_));
  }
  const auto bytes = std::uint64_t(bits_.tellp());
  WholeFile file(path_);
  writeMaskHeader(cine_, poses_, segments, frames_, file.stream());
  bits_.seekg(0);
  file.stream() << bits_.rdbuf() << std::string(bytes % 2, '\0'); // an element's length is even
  tally_.requireRoom(bool(bits_) && file.finish());
}

} // namespace sono
