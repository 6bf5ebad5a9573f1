#include "DataSets/DataSet.h"

namespace sono {

const char* nameOf(Split split)
{
  constexpr const char* names[splitCount] = { "train", "validation", "test" };
  return names[int(split)];
}

const char* nameOf(ImageChannel channel)
{
  constexpr const char* names[imageChannelCount] = { "grey", "mask", "label", "tissue", "error", "beam" };
  return names[int(channel)];
}

const char* nameOf(SettingsGroup group)
{
  constexpr const char* names[] = { "probe", "tracing", "echo", "display" };
  return names[int(group)];
}

} // namespace sono
