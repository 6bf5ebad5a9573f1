#include "Trace/Rod.h"

#include "Core/SoundSpeed.h"
#include "Trace/Targets.h"

namespace sono {

std::optional<Rod> ringingRod(const TargetSurface& target)
{
  constexpr double hard = 2.0; // times soft tissue
  const Tissue& tissue = target.tissue;
  const bool rings = target.rodDiameterMm > 0.0 && tissue.soundSpeedMPerS > hard * 1000.0 * assumedSoundSpeedMmPerUs &&
                     tissue.impedanceMRayl > hard * aroundRodsMRayl;
  return rings ? std::optional<Rod>(Rod{ 0.5 * target.rodDiameterMm, tissue.impedanceMRayl, tissue.soundSpeedMPerS,
                                         0.5 * tissue.soundSpeedMPerS })
               : std::nullopt;
}

} // namespace sono
