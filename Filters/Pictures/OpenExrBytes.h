#pragma once

#include "DataSets/ChannelImage.h"

#include <string>

/// The other function of the library that writes pictures (see WritePicture.h): the bytes of an OpenEXR file with these
/// channels, as floats, its numbers and texts as attributes, deflated. `failure` is empty then, or why there are none.
extern "C" void sonoOpenExrBytes(const sono::ChannelImage& image, std::string& bytes, std::string& failure);
