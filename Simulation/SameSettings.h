#pragma once

#include "Core/KeyText.h"
#include "Image/DisplaySettings.h"
#include "ImageSettings.h"
#include "Trace/Targets.h"

#include <vector>

namespace sono {

// Whether two are the same to the bit, and give the same result therefore; what is shared counts as the same when it is
// the same object.

/// All of it, to the last bit. False where that cannot be written down, because something is shared: field, pulse.
bool describe(const ImageSettings& settings, KeyText& key);
void describe(const ProbePose& pose, KeyText& key);

bool same(const TraceSettings& a, const TraceSettings& b);
bool same(const EchoSettings& a, const EchoSettings& b);
bool same(const BModeSettings& a, const BModeSettings& b);
bool same(const DisplaySettings& a, const DisplaySettings& b);
bool same(const ScanGeometry& a, const ScanGeometry& b);
bool same(const ProbePose& a, const ProbePose& b);
bool same(const std::vector<ScanLine>& a, const std::vector<ScanLine>& b);
bool same(const std::vector<TargetSurface>& a, const std::vector<TargetSurface>& b);

} // namespace sono
