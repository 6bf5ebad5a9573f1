#pragma once

#include "Core/Progress.h"
#include "Labels/MatchedScan.h"

#include <string>
#include <vector>

namespace sono {

/// Names what a CT shows where a label map has none: 0 inside the body becomes the new labels "skin" (the outer
/// `skinMm`), "gas" and "lung" (below -300 HU; lung where such voxels lie together in 20 ml or more with a mean from
/// -930 to -400), "fat" (up to -30), "muscle" and "bone" (from 200, or from 150 above the blood where that has a
/// contrast agent). Those that do not occur are not added; where the scan does not reach 0 becomes "muscle". Other
/// labels and the 0 outside stay. The thresholds are chosen.
///
/// The body is what is labelled or above -300 HU, gaps of 12 mm closed, without parts smaller than a twentieth of the
/// largest (the table's), holes filled in each axial slice; along the volume's border it goes on, so a cropped scan
/// gets no skin there. `bloodHu`: the mean of the blood, if any is labelled, else 0. Returns the names that were added.
/// Throws Error for an MR, or without free ids, and Aborted; the volume is then as it was.
std::vector<std::string> fillFromCt(LabelVolume& volume, const MatchedScan& ct, double skinMm, double bloodHu,
                                    const Progress& progress = {});

} // namespace sono
