#pragma once

#include "Kernel/EchoSplat.h"

namespace sono {

/// Calls loop(profile), where profile(depthMm) is the weight of a Gaussian beam at a depth >= 0. A loop that asks at
/// each step how the beam receives is no vector loop: each way of receiving has a loop of its own.
template<class Loop>
inline void withProfile(const Beam& beam, const Loop& loop)
{
  if (beam.kind == BeamKind::Gaussian)
  {
    const ProfileAt at = gaussianAt(beam, 0.0f);
    loop([at](float) { return at; });
    return;
  }
  const auto received = [&](bool lateralLens, bool elevationalLens) {
    ApertureProfile profile = beam.profile;
    profile.lateral.lens = lateralLens;
    profile.elevational.lens = elevationalLens;
    loop([profile](float depthMm) { return profileAt(profile, depthMm); });
  };
  const ApertureProfile& p = beam.profile;
  if (p.lateral.lens)
  {
    p.elevational.lens ? received(true, true) : received(true, false);
  }
  else
  {
    p.elevational.lens ? received(false, true) : received(false, false);
  }
}

} // namespace sono
