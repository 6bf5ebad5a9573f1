#pragma once

#include "Channels/ChannelPlan.h"

class vtkImageData;
class vtkInformation;

namespace sono {

// Channel data as an image: samples x elements x transmits, see vtkSonoChannelData.

void announceChannels(const ChannelPlan& plan, vtkInformation* outInfo);
/// Field data that are there already stay beside what is added.
void fillChannels(const ChannelPlan& plan, const ChannelData& data, vtkImageData* image);

/// How such an image was sent and heard.
struct ChannelLayout
{
  ArrayElements elements;
  Transmits transmits;
  double samplingMHz = 0.0;
  int sampleCount = 0;
};

/// Whether an image says that it is one of channels.
bool holdsChannels(vtkImageData* image);
/// Throws Error where something is missing or does not fit.
ChannelLayout channelLayout(vtkImageData* image);

} // namespace sono
