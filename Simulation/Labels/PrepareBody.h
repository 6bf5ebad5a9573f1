#pragma once

#include "Labels/AssignTissues.h"
#include "Labels/BodyFill.h"
#include "Labels/LabelVolume.h"
#include "Labels/TissueTable.h"

#include <string>
#include <vector>

namespace sono {

/// Whether label 0 inside a body becomes skin and soft tissue.
enum class BodyFillMode
{
  Off,
  On,
  Auto ///< where organs, bones or muscles lie bare; a bare organ gets a bath of tissue (see bodyEnd)
};

/// Gives each label its tissue (guessHeart, assignTissues) and ends the body at its skin, as Auto wants it; of On,
/// whose fillBody comes first, it says nothing. Returns what a person should know, a sentence each: tissues that are
/// guesses, what was filled, a heart without chambers. Throws Error as fillBody and assignTissues do.
std::vector<std::string> prepareBody(LabelVolume& volume, const LabelTissueMap& map, const TissueTable& table,
                                     const std::string& fallbackTissue, BodyFillMode fill,
                                     const BodyFillSettings& settings = {});

} // namespace sono
