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

/// Which heart. Scales are those of the chambers' ellipsoids across their axes.
struct HeartShape
{
  double leftScale = 1.0;        ///< left ventricle; its length goes with the square root
  double rightScale = 1.0;       ///< right ventricle
  double leftAtriumScale = 1.0;  ///< from the annulus away
  double rightAtriumScale = 1.0; ///< from the annulus away
  double wallMm = 10.0;          ///< of the left ventricle
  double valveOpening = 0.4;     ///< tips' radius over the annulus'
  double apartMm = 0.0;          ///< by which left atrium and outflow tract are further apart

  /// How much wider the left ventricle is on its right side: the right heart makes room.
  double rightwardMm() const { return 22.0 * leftScale + wallMm - 32.0; }
};

/// What stands at a point of the heart's frame.
HeartSample sampleHeart(const Vec3d& p, const HeartShape& shape);

/// Points of a heart, in its frame, mm.
struct HeartPoints
{
  Vec3d apex; ///< of the left ventricle's cavity
  Vec3d mitral, tricuspid;
  double mitralRadiusMm, tricuspidRadiusMm, aorticRadiusMm;
  Vec3d leftVentricle, rightVentricle, leftAtrium, rightAtrium; ///< centres of the ellipsoids
};

HeartPoints heartPoints(const HeartShape& shape);

/// Where the left ventricular outflow tract ends: centre of the aortic valve in the heart's frame.
Vec3d aorticValveCentreMm();

/// Unit direction of flow through the aortic valve, in the heart's frame.
Vec3d aorticFlowDirection();

/// A sphere that holds the heart, in the heart's frame.
Vec3d heartSphereCentreMm();
double heartSphereRadiusMm(const HeartShape& shape);

} // namespace sono
