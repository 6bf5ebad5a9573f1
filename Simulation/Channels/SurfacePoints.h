#pragma once

#include "Channels/ChannelPoints.h"
#include "Channels/FanPlaces.h"
#include "Core/Progress.h"
#include "Echo/EchoSetup.h"

namespace sono {

/// The surfaces that the picture sees as points: coherent ones, 0.45 wavelengths apart so that whatever element sends
/// and hears, all that is not mirrored cancels (between neighbours the phase turns by less than a cycle), of amplitude
///   -i r cos t exp(-2 (k h cos t)^2) f dA / c                                                              (15.5)
/// and diffuse ones with the picture's cross-sections and phases. Intensities as for lines (section 10.6).
ChannelPoints surfacePoints(const EchoSetup& setup, const FanPlaces& fan, const ProbeFrame& frame,
                            const ProbeSettings& probe, const Progress& progress);

} // namespace sono
