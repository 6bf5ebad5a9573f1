#pragma once

#include "ImageSettings.h"

#include <cstddef>

// Images that go through the stages of a GPU together.

namespace sono {

struct TraceSetup;

/// Some line of each image meets the label map, as where each is asked for alone; else throws Error, naming the pose.
void requireEachMeets(const TraceSetup& setup, std::size_t images);

/// Images of these settings that fit on the device beside each other, at least 1.
int imagesThatFit(const ImageSettings& settings);

} // namespace sono
