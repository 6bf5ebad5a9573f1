#pragma once

#include "Core/Parameters.h"
#include "Core/Progress.h"
#include "Labels/LabelVolume.h"

namespace sono {

/// How fillBody estimates where the body ends.
struct BodyFillSettings
{
  double closingMm = 50.0;
  double wallMm = 10.0;
  double skinMm = 2.0;

  template<class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor(self.closingMm,
            Parameter{ "closingMm", "Closing (mm)", between(0, 200),
                       "Gaps between labels up to twice as wide belong to the body, in mm, 0 to 200." });
    visitor(self.wallMm,
            Parameter{ "wallMm", "Wall (mm)", between(0, 100),
                       "Body wall: unlabelled tissue outside the outermost labels, skin included, in mm, 0 to 100." });
    visitor(self.skinMm, Parameter{ "skinMm", "Skin (mm)", between(0, 20), "Thickness of the skin in mm, 0 to 20." });
  }
};

/// What fillBody added.
struct BodyFill
{
  int skinId = 0;
  int softTissueId = 0;
  std::size_t skinVoxels = 0;
  std::size_t softTissueVoxels = 0;
};

/// Fills the body of a label map whose 0 means both the air outside and tissue that has no label, as
/// TotalSegmentator leaves it: the outer `skinMm` become the new label "skin", the rest of the 0 inside "soft_tissue".
/// Other labels and the 0 outside stay.
///
/// The map does not show where the skin is: the body is estimated as the labels closed by a ball of `closingMm` and
/// grown by `wallMm`, without parts smaller than a twentieth of the largest, holes filled in each axial slice. A
/// thyroid lies close to the skin: within 60 degrees of straight before one the closing is 8 mm at most, or it would
/// bridge chin and chest. Beyond the volume's border the outermost labels go on, so a cropped scan gets no skin along
/// the cut. Works on a grid of about 3 mm, interpolated. Throws Error for a setting out of range, a map without any
/// label but 0, or without two free ids.
BodyFill fillBody(LabelVolume& volume, const BodyFillSettings& settings = {}, const Progress& progress = {});

} // namespace sono
