#pragma once

#include "Labels/LabelVolume.h"
#include "Phantoms/ThoraxParameters.h"
#include "Probe/ScanGeometry.h"

#include <set>
#include <vector>

namespace sono {

/// The bundled anatomy: a parametric adult thorax (outside, skin, subcutaneous fat, muscle, ribs, sternum,
/// spine, lungs, mediastinal fat, pericardium, myocardium with septum, four blood-filled chambers, mitral,
/// tricuspid and aortic valve, aorta, liver, stomach) made of implicit shapes, so that it exists at any voxel size.
/// @param spacingMm voxel size, 0.5 to 5 mm. At 1 mm the map is 292 x 212 x 250 voxels.
/// @param parameters which body of the family; the box grows with it
/// Throws Error for any other spacing, and for parameters outside their ranges.
/// Walls of 2 to 4 mm (atria, right ventricle, valves, pericardium) are closed up to a spacing of 2 mm.
LabelVolume makeThoraxPhantom(double spacingMm, const ThoraxParameters& parameters = {});

/// How far what its heart's motion carries has come since the end of diastole, in mm at the voxels of a grid, i
/// fastest: the place less ThoraxBody::restingPlaceMm. 0 at phase 0.
std::vector<Vec3f> thoraxDisplacementMm(const GridPlacement& grid, const ThoraxParameters& parameters);

/// The labels that ride on the motion, the same at each phase: the walls, septa, papillary muscles and valves, not the
/// blood.
const std::set<int>& thoraxMovingLabels();

/// The pose of its apical four-chamber view: on the skin in an intercostal space, axis toward the mitral
/// annulus, lateral toward the left ventricle's free wall.
ProbePose thoraxPhantomA4C(const ThoraxParameters& parameters = {});

} // namespace sono
