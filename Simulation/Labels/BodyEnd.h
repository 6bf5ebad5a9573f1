#pragma once

#include "Core/Progress.h"
#include "Labels/BodyFill.h"
#include "Labels/LabelVolume.h"

#include <string>
#include <vector>

namespace sono {

/// What a label map has where its labels end at 0.
enum class BodyEnd
{
  Skin,     ///< skin, or something else that may lie bare, or nobody can tell
  NoSkin,   ///< a body whose organs, bones or muscles lie bare, as TotalSegmentator leaves it
  BareOrgan ///< one or a few organs alone: no bone or lung, no more than 200 mm in any direction, not cut at both ends
};

/// By the tissues of the labels, which must be assigned; `unmapped` names those whose tissue is a guess. Labels without
/// any known name are taken for an organ when they are two or more and none touches the volume's border.
BodyEnd bodyEnd(const LabelVolume& volume, const std::vector<std::string>& unmapped);

/// Puts a bath of soft tissue with skin, `bathMm` thick, around what has labels: fillBody in a volume that is enlarged
/// as far as it must be. Throws Error as fillBody does.
constexpr double bathMm = 40.0;
BodyFill batheOrgan(LabelVolume& volume, BodyFillSettings settings, const Progress& progress = {});

/// Whether the heart is a label of its own, without blood in its chambers.
bool hasHeartWithoutChambers(const LabelVolume& volume);

} // namespace sono
