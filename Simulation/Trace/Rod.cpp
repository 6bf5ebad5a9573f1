#include "Trace/Rod.h"

#include "Core/SoundSpeed.h"
#include "Labels/TissueTable.h"

namespace sono {

Rod rodOf(const Tissue& tissue, double diameterMm)
{
  return { 0.5 * diameterMm, tissue.impedanceMRayl, tissue.soundSpeedMPerS, 0.5 * tissue.soundSpeedMPerS };
}

bool rings(const Rod& rod)
{
  constexpr double hard = 2.0; // times soft tissue
  return rod.radiusMm > 0.0 && rod.soundSpeedMPerS > hard * 1000.0 * assumedSoundSpeedMmPerUs &&
         rod.impedanceMRayl > hard * aroundRodsMRayl;
}

} // namespace sono
