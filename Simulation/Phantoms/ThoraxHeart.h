#pragma once

#include "Kernel/Vec.h"
#include "Phantoms/ThoraxLabels.h"

namespace sono {

/// The heart's own frame is that of the apical four-chamber view: x lateral (towards the left ventricle's free
/// wall), y elevation (inferior and posterior), z depth from the skin, in mm. The image plane is y = 0.
struct HeartSample
{
  ThoraxLabel label = Background; ///< Background where there is no heart
  double outsideMm = 1e9;         ///< distance from the pericardium's outer surface, negative inside
};

/// What stands at a point of the heart's frame.
HeartSample sampleHeart(const Vec3d& p);

/// Centre of the mitral and of the tricuspid annulus, in the heart's frame.
Vec3d mitralAnnulusCentreMm();
Vec3d tricuspidAnnulusCentreMm();

/// Where the left ventricular outflow tract ends: centre of the aortic valve in the heart's frame.
Vec3d aorticValveCentreMm();

/// Unit direction of flow through the aortic valve, in the heart's frame.
Vec3d aorticFlowDirection();

/// A sphere that holds the heart, in the heart's frame.
Vec3d heartSphereCentreMm();
double heartSphereRadiusMm();

} // namespace sono
