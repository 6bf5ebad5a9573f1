#pragma once

#include "Labels/LabelVolume.h"

namespace sono {

/// Names the labels of a heart of MM-WHS, whose file says nothing but whose numbers no other list has: 205, 420, 500,
/// 550, 600, 820 and 850 (421 stands for 420 in some). Does so only where no label but 0 has a name, all numbers are of
/// these, and there are three or more. Other lists are never guessed from numbers: TotalSegmentator's versions give the
/// same number to different organs.
void nameKnownNumbers(LabelVolume& volume);

} // namespace sono
