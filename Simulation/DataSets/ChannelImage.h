#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace sono {

/// A picture of floats with named channels, for a file.
struct ChannelImage
{
  int width = 0;
  int height = 0;
  std::vector<std::string> names;                      ///< of the channels
  std::vector<std::vector<float>> values;              ///< of each channel, width x height, rows from the top
  std::vector<std::pair<std::string, double>> numbers; ///< what else there is to say, by name
  std::vector<std::pair<std::string, std::string>> texts;

  void add(const std::string& name, std::vector<float> channel)
  {
    names.push_back(name);
    values.push_back(std::move(channel));
  }
};

/// The bytes of an OpenEXR file, the same for the same picture, from any thread. Throws Error.
using EncodeExr = std::function<std::string(const ChannelImage&)>;

} // namespace sono
