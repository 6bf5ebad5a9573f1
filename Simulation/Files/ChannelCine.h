#pragma once

#include "Channels/Transmits.h"
#include "Files/FrameOrder.h"

#include <memory>
#include <string>
#include <vector>

namespace sono {

/// What there is to say of a sequence of channel data (ChannelData) besides their numbers.
struct ChannelCineInfo
{
  ProbeSettings probe;
  ProbePose pose;
  ArrayElements elements;
  Transmits transmits;
  int sampleCount = 0;
  double samplingMHz = 0.0;
  std::vector<double> timesS; ///< of each frame, in increasing order

  std::size_t valueCount() const
  {
    return transmits.each.size() * elements.centresMm.size() * std::size_t(sampleCount);
  }
};

/// A file of channel data, RF. `rf` of a frame is transmits x elements x samples, sample s at time s / samplingMHz;
/// time 0 is as in Transmits.
class ChannelCine
{
public:
  virtual ~ChannelCine() = default;
  /// The next frame. Throws Error for another size, one too many, and a full disk.
  void add(const std::vector<float>& rf);
  /// Throws Error where frames are missing, or the disk is full. Before it there is no file of that name.
  void finish();

protected:
  ChannelCine(const std::string& path, const ChannelCineInfo& info);

private:
  virtual void write(std::size_t frame, const std::vector<float>& rf) = 0;
  virtual void close() = 0;

  FrameOrder frames_;
};

/// One in zea's format (.hdf5): raw_data, frames x transmits x samples x elements x 1.
std::unique_ptr<ChannelCine> zeaChannels(const std::string& path, const ChannelCineInfo& info);
/// One in the Ultrasound File Format of USTB (.uff): a uff.channel_data whose time 0 is when each wave passes the
/// origin.
std::unique_ptr<ChannelCine> uffChannels(const std::string& path, const ChannelCineInfo& info);
/// One of these by the name's ending. Throws Error naming the file for another one, and for what cannot be written.
std::unique_ptr<ChannelCine> channelFile(const std::string& path, const ChannelCineInfo& info);

} // namespace sono
