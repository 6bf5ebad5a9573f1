#pragma once

#include "Labels/LabelVolume.h"
#include "Probe/ScanGeometry.h"

namespace sono {

/// The bundled anatomy: a parametric adult thorax (outside, skin, subcutaneous fat, muscle, ribs, sternum,
/// spine, lungs, mediastinal fat, pericardium, myocardium with septum, four blood-filled chambers, mitral,
/// tricuspid and aortic valve, aorta, liver, stomach) made of implicit shapes, so that it exists at any voxel size.
/// @param spacingMm voxel size, 0.5 to 5 mm. At 1 mm the map is 292 x 212 x 250 voxels.
/// Throws Error for any other spacing.
/// Walls of 2 to 4 mm (atria, right ventricle, valves, pericardium) are closed up to a spacing of 2 mm.
LabelVolume makeThoraxPhantom(double spacingMm);

/// The pose of its apical four-chamber view: on the skin in an intercostal space, axis toward the mitral
/// annulus, lateral toward the left ventricle's free wall.
ProbePose thoraxPhantomA4C();

} // namespace sono
