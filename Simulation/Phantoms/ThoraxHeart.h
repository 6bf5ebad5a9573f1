#pragma once

#include "Kernel/Vec.h"
#include "Phantoms/ThoraxLabels.h"
#include "Phantoms/ThoraxShapes.h"

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

/// An atrioventricular valve: two leaflets that form a funnel from the annulus into the ventricle.
struct HeartValve
{
  Vec3d centreMm;
  double annulusRadiusMm;
  double tipRadiusMm;
  double heightMm;
  Vec3d tipShiftMm; ///< makes one leaflet longer than the other
};

/// Bounds of a distance.
struct DistanceBounds
{
  double leastMm;
  double mostMm;
};

/// A heart of a shape, with what follows from that alone.
class Heart
{
public:
  explicit Heart(const HeartShape& shape);

  const HeartShape& shape() const { return shape_; }
  /// What stands at a point of the heart's frame.
  HeartSample sample(const Vec3d& p) const;
  /// The same at many points, by vectors: a third of the time.
  void sampleEach(const Vec3d* points, int count, HeartSample* samples) const;
  /// Bounds of `outsideMm` at all points within `aroundMm` of one, a fifth of the time of a sample: from those of the
  /// ellipsoids and tubes that the heart is blended of.
  DistanceBounds outsideMm(const Vec3d& p, double aroundMm) const;
  /// Whether a point lies in the sphere that holds the heart.
  bool isNear(const Vec3d& p) const;

private:
  struct Surfaces;

  Surfaces surfacesAt(const Vec3d& p) const;
  HeartSample sampleOf(const Surfaces& f, const Vec3d& p) const;
  void addLeftVentricle(Surfaces& f, const Vec3d& p) const;
  void addRightVentricle(Surfaces& f, const Vec3d& p) const;
  void addAtria(Surfaces& f, const Vec3d& p) const;
  Vec3d inRightVentricle(const Vec3d& p) const;
  ThoraxLabel leftBlood(const Surfaces& f, const Vec3d& p) const;
  ThoraxLabel rightBlood(const Vec3d& p) const;
  bool facesRightVentricle(const Surfaces& f, const Vec3d& p) const;
  ThoraxLabel wall(const Surfaces& f, const Vec3d& p) const;

  HeartShape shape_;
  double sphereRadiusMm_;
  double rightwardMm_;
  HeartValve mitral_, tricuspid_;
  shapes::Ellipsoid leftVentricle_, leftEpicardium_, leftAtrium_, rightAtrium_;
  /// In the right ventricle's own axes: the cavity, and grown by the septum's and by the wall's thickness.
  shapes::Ellipsoid rightVentricle_, rightOfSeptum_, rightEpicardium_;
  shapes::Capsule outflow_;
  Vec3d perGrown_; ///< of the left ventricle against the default one's
};

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
