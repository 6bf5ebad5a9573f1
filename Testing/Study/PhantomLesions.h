#pragma once

#include "Detectability.h"
#include "PhantomImaging.h"

#include <vector>

namespace sono::study {

/// The pixels of a lesion and of plain gel beside it: circles of 80 % of its diameter, to stay clear of the blurred
/// edge, around the lesion's centre and around the point that mirrors it on the view's middle, which has the same depth
/// and the same distance from the beam's axis.
Detectability lesionDetectability(const PhantomImaging& imaging, const std::vector<float>& envelope,
                                  const PhantomTarget& lesion);

} // namespace sono::study
