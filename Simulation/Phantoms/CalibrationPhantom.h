#pragma once

#include "Echo/PointScatterers.h"
#include "Labels/LabelVolume.h"
#include "Phantoms/PhantomTargets.h"
#include "Probe/ScanGeometry.h"
#include "Trace/Targets.h"

#include <vector>

namespace sono {

/// A virtual general-purpose phantom after the model 040GSE: a block of gel, 178 mm wide and 203 mm deep, with wires
/// and cylinders along the elevation axis (Data/phantom_040gse.csv). Its axes are the world's: x lateral, y
/// elevational, z depth; the probe stands on z = 0.
struct CalibrationPhantomSettings
{
  double spacingMm = 0.5;    ///< edge of a voxel, 0.1 to 5
  double thicknessMm = 30.0; ///< along the elevation axis, 1 to 127: the beam needs no more than its own height
  double viewPitchMm = 45.0; ///< lateral distance of two views, 0 to 89
  bool wiresAsVoxels =
    false; ///< each wire as the column of voxels that holds its centre; else the labels have no wires

  /// Throws Error naming the parameter and its range.
  void validate() const;
};

/// The phantom's label map; label names are the tissues of `targets`, and "phantom_gel" between them. A voxel belongs
/// to the last target that holds its centre. Throws Error for settings out of range or a target outside the block.
LabelVolume makeCalibrationPhantom(const std::vector<PhantomTarget>& targets,
                                   const CalibrationPhantomSettings& settings);

/// Where the probe stands for a view, 1 to phantomViewCount. Throws Error for another.
ProbePose phantomViewPose(const CalibrationPhantomSettings& settings, int view);

/// Centre of a target's cross-section in the world, mm; y is 0.
Vec3d phantomTargetCentreMm(const CalibrationPhantomSettings& settings, const PhantomTarget& target);

/// The wires as closed surfaces for the tracer: prisms of 8 sides with the wires' cross-section. All are of the
/// tissue of the first. Throws Error when there are no wires or the table lacks the tissue.
TargetSurface phantomWireSurface(const std::vector<PhantomTarget>& targets, const CalibrationPhantomSettings& settings,
                                 const TissueTable& tissues);

/// The wires as what they are to a beam that is wider than they: lines of scatterers, one every `stepMm` (> 0; a tenth
/// of a millimetre is far below the beam's height), of amplitude `amplitudePerMm` stepMm each.
std::vector<PointScatterer> phantomWireScatterers(const std::vector<PhantomTarget>& targets,
                                                  const CalibrationPhantomSettings& settings, double amplitudePerMm,
                                                  double stepMm = 0.1);

} // namespace sono
