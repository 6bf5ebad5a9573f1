#pragma once

#include "Channels/ChannelPlan.h"
#include "Study.h"

#include <memory>
#include <string>
#include <vector>

namespace sono::study {

/// A scene that programs of others can do, too: points before a row of elements in water without attenuation.
struct PeerScene
{
  std::string name;
  std::string words; ///< what it is, for the report
  ChannelSettings settings;
  ProbeSettings probe;
  std::string waves;      ///< sphere (elements of a height), flat (r^-1/2 exp(ikr)) or cylinder (H0(kr))
  std::string pulse;      ///< what the peers send: simus, hann or burst (peers/reference.py)
  double deviationUs = 0; ///< of the burst
  ChannelPoints points;

  ChannelPlan plan(std::shared_ptr<const SampledPulse> pulse = nullptr) const;
};

/// plane, lens, array and waves; of few points when `quick`.
std::vector<PeerScene> peerScenes(bool quick);

/// Writes peers_scenes.json, which peers/measure.py reads.
void writePeerScenes(const Output& output, const std::vector<PeerScene>& scenes);

} // namespace sono::study
