#include "Files/ChannelCine.h"

#include "Files/EchoFormat.h"

namespace sono {

ChannelCine::ChannelCine(const std::string& path, const ChannelCineInfo& info)
  : frames_(path, info.valueCount(), info.timesS, "channels",
            "keep the probe, its depth and what it sends the same in all")
{
}

void ChannelCine::add(const std::vector<float>& rf)
{
  write(frames_.next(rf.size()), rf);
}

void ChannelCine::finish()
{
  frames_.finish();
  close();
}

std::unique_ptr<ChannelCine> channelFile(const std::string& path, const ChannelCineInfo& info)
{
  switch (echoFormatOf(path))
  {
    case EchoFormat::Zea:
      return zeaChannels(path, info);
    default:
      return uffChannels(path, info);
  }
}

} // namespace sono
