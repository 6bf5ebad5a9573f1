#include "Phantoms/ThoraxHeart.h"

#include "Phantoms/ThoraxShapes.h"

namespace sono {

using namespace shapes;

namespace {

// Depths of the valve planes; the tricuspid valve sits nearer to the apex, as in every normal heart.
const Vec3d mitralCentre(0.0, 0.0, 113.0);
const Vec3d tricuspidCentre(-46.0, 0.0, 106.0); // of the default heart
const Vec3d aorticCentre(-7.0, -28.0, 112.0);
const Vec3d outflowStart(0.0, -14.0, 94.0);

constexpr double mitralRadiusMm = 16.0;
constexpr double tricuspidRadiusMm = 18.0;
constexpr double outflowRadiusMm = 11.0;
constexpr double atrialWallMm = 2.5;
constexpr double pericardiumMm = 1.8;

/// An atrioventricular valve: two leaflets that form a funnel from the annulus into the ventricle.
struct Valve
{
  Vec3d centreMm;
  double annulusRadiusMm;
  double tipRadiusMm;
  double heightMm;
  Vec3d tipShiftMm; ///< makes one leaflet longer than the other
};

/// The right heart, shifted to make room for the left one.
Vec3d besideLeft(const Vec3d& p, const HeartShape& shape)
{
  return p - Vec3d(shape.rightwardMm(), 0.0, 0.0);
}

/// Opens or closes a valve that is given half open: the leaflets keep their length, so that a closed one is flatter; a
/// wide ring's stretch to meet.
Valve opened(Valve valve, double opening)
{
  const double narrowing = valve.annulusRadiusMm - valve.tipRadiusMm;
  const double length2 = valve.heightMm * valve.heightMm + narrowing * narrowing;
  valve.tipRadiusMm *= opening / 0.4;
  const double narrowed = valve.annulusRadiusMm - valve.tipRadiusMm;
  const double leastMm = 0.3 * valve.annulusRadiusMm;
  valve.heightMm = std::sqrt(std::max(length2 - narrowed * narrowed, leastMm * leastMm));
  return valve;
}

Valve mitralOf(const HeartShape& shape)
{
  const double size = std::sqrt(shape.leftScale);
  return opened({ mitralCentre, mitralRadiusMm * size, 6.5 * size, 15.0, Vec3d(2.5, 1.0, 0.0) }, shape.valveOpening);
}

Valve tricuspidOf(const HeartShape& shape)
{
  return opened(
    { besideLeft(tricuspidCentre, shape), tricuspidRadiusMm * shape.rightScale, 7.0, 14.0, Vec3d(-2.0, 0.0, 0.0) },
    shape.valveOpening);
}

Vec3d leftAtriumCentre(const HeartShape& shape)
{
  return Vec3d(2.0, 0.0, 112.5 + 17.5 * shape.leftAtriumScale); // grows away from the annulus
}

Vec3d rightAtriumCentre(const HeartShape& shape)
{
  return besideLeft(Vec3d(-46.0, -3.0, 104.0 + 22.0 * shape.rightAtriumScale), shape);
}

const Vec3d leftVentricleCentre(5.0, -0.5, 87.0);

Vec3d leftVentricleRadii(const HeartShape& shape)
{
  return Vec3d(22.0 * shape.leftScale, 24.0 * shape.leftScale, 56.0 * std::sqrt(shape.leftScale));
}

enum class ValveSide
{
  Atrium,
  Leaflet,
  Ventricle
};

ValveSide valveSide(const Valve& valve, const Vec3d& p)
{
  constexpr double halfThicknessMm = 1.05;
  const double s = (valve.centreMm.z - p.z) / valve.heightMm; // 0 at the annulus, 1 at the tips
  if (s < 0.0)
  {
    return ValveSide::Atrium;
  }
  if (s > 1.0)
  {
    return ValveSide::Ventricle;
  }
  const Vec3d q = p - valve.centreMm - s * valve.tipShiftMm;
  const double narrowing = valve.annulusRadiusMm - valve.tipRadiusMm;
  // The leaflets bulge a little towards the atrium, and the opening is wider from commissure to commissure.
  const double radius = valve.annulusRadiusMm - narrowing * s * (1.25 - 0.25 * s);
  const double slope = narrowing / valve.heightMm;
  const double distance = (std::hypot(q.x, q.y / (1.0 + 0.5 * s)) - radius) / std::hypot(1.0, slope);
  if (std::abs(distance) <= halfThicknessMm)
  {
    return ValveSide::Leaflet;
  }
  return distance < 0.0 ? ValveSide::Atrium : ValveSide::Ventricle;
}

/// Tube through a valve's annulus, which joins ventricle and atrium.
double annulusTube(const Valve& valve, const Vec3d& p, double apicalMm, double atrialMm)
{
  const Vec3d q = p - valve.centreMm;
  const double radial = std::hypot(q.x, q.y) - valve.annulusRadiusMm;
  return std::max({ radial, -q.z - apicalMm, q.z - atrialMm });
}

/// Low-frequency irregularity, below 1 mm: no wall is a perfect ellipsoid.
Vec3d warped(const Vec3d& p)
{
  return p + Vec3d(0.9 * std::sin(0.11 * p.z + 0.06 * p.y) + 0.5 * std::sin(0.17 * p.z + 1.0),
                   0.9 * std::sin(0.10 * p.z - 0.08 * p.x + 2.0), 0.7 * std::sin(0.09 * p.x + 0.10 * p.y + 0.5));
}

/// Every surface of the heart at one point.
struct HeartSurfaces
{
  double leftVentricle;   ///< cavity
  double leftEpicardium;  ///< outer surface of the left ventricle and of its outflow tract
  double outflow;         ///< cavity of the outflow tract
  double rightVentricle;  ///< cavity
  double rightEpicardium; ///< outer surface of the right ventricle, continued into the left
  double leftAtrium;      ///< cavity, with the annulus
  double rightAtrium;     ///< cavity, with the annulus
};

void addLeftVentricle(HeartSurfaces& f, const Vec3d& p, const HeartShape& shape)
{
  const Vec3d epicardiumCentre(5.5, -0.5, 87.0);
  // Trabeculae: a ripple of the endocardium that fades towards the base.
  const double ripple = 0.5 * std::sin(0.45 * p.z + 0.3 * p.y) * smoothStep(105.0, 75.0, p.z);
  const double inner = ellipsoid(p - leftVentricleCentre, leftVentricleRadii(shape)) + ripple;
  const Vec3d wall = (shape.wallMm / 10.0) * Vec3d(10.0, 9.5, 6.5);
  const double outer = ellipsoid(p - epicardiumCentre, leftVentricleRadii(shape) + wall);
  f.outflow = capsule(p, outflowStart, aorticCentre, outflowRadiusMm, outflowRadiusMm);
  f.leftVentricle = smoothUnion(smoothIntersection(inner, p.z - 108.5, 8.0), f.outflow, 4.0);
  f.leftEpicardium = smoothUnion(smoothIntersection(outer, p.z - 114.5, 5.0), f.outflow - 3.5, 3.0);
}

const Vec3d rightVentricleCentre(-18.0, -3.0, 85.0);

/// The right ventricle's ellipsoid, grown by `wallMm`. It reaches into the left ventricle, which cuts a crescent
/// out of it; its long axis goes from the apex, close to the septum, to the tricuspid annulus.
double rightEllipsoid(const Vec3d& p, const HeartShape& shape, double wallMm)
{
  static const Vec3d longAxis = glm::normalize(Vec3d(-0.42, -0.08, 0.90));
  static const Vec3d sideAxis = glm::normalize(glm::cross(Vec3d(0.0, 1.0, 0.0), longAxis));
  static const Vec3d depthAxis = glm::cross(longAxis, sideAxis);
  const Vec3d q = p - besideLeft(rightVentricleCentre, shape);
  const Vec3d local(glm::dot(q, sideAxis), glm::dot(q, depthAxis), glm::dot(q, longAxis));
  return ellipsoid(local, shape.rightScale * Vec3d(44.0, 37.0, 44.0) + wallMm);
}

void addRightVentricle(HeartSurfaces& f, const Vec3d& p, const HeartShape& shape)
{
  const double ripple = 0.6 * std::sin(0.5 * p.z - 0.35 * p.x) * smoothStep(100.0, 65.0, p.z);
  const double inner = rightEllipsoid(p, shape, 0.0) + ripple;
  f.rightVentricle = smoothIntersection(smoothIntersection(inner, p.z - 101.5, 6.0), -f.leftEpicardium, 4.0);
  f.rightEpicardium = smoothIntersection(rightEllipsoid(p, shape, 4.0), p.z - 107.5, 5.0);
}

void addAtria(HeartSurfaces& f, const Vec3d& p, const HeartShape& shape)
{
  const double aside = 0.5 * shape.rightwardMm();
  // The bodies are cut by the plane of the interatrial septum; the septum is what is left between them.
  const double left = smoothIntersection(
    ellipsoid(p - leftAtriumCentre(shape), shape.leftAtriumScale * Vec3d(25.0, 25.0, 17.5)), -20.0 - aside - p.x, 3.0);
  const double right = smoothIntersection(
    ellipsoid(p - rightAtriumCentre(shape), shape.rightAtriumScale * Vec3d(28.0, 26.0, 22.0)), p.x + 22.5 + aside, 3.0);
  f.leftAtrium = smoothUnion(left, annulusTube(mitralOf(shape), p, 8.0, 8.0), 3.0);
  f.rightAtrium = smoothUnion(right, annulusTube(tricuspidOf(shape), p, 8.0, 8.0), 3.0);
  // The outflow tract and its wall pass between the atria.
  f.leftAtrium = smoothIntersection(f.leftAtrium, 3.5 + shape.apartMm - f.outflow, 2.0);
  f.rightAtrium = smoothIntersection(f.rightAtrium, -f.leftEpicardium, 3.0);
}

HeartSurfaces heartSurfaces(const Vec3d& p, const HeartShape& shape)
{
  HeartSurfaces f{};
  addLeftVentricle(f, p, shape);
  addRightVentricle(f, p, shape);
  addAtria(f, p, shape);
  return f;
}

ThoraxLabel leftBlood(const HeartSurfaces& f, const Vec3d& p, const HeartShape& shape)
{
  if (f.outflow < 0.0)
  {
    return LeftVentricleBlood;
  }
  // The muscles keep to the wall whatever the size of the cavity.
  const Vec3d grown = leftVentricleRadii(shape) / Vec3d(22.0, 24.0, 56.0);
  const Vec3d m = shape.leftScale == 1.0 ? p : leftVentricleCentre + (p - leftVentricleCentre) / grown;
  // Anterolateral and posteromedial papillary muscles, from the middle of the free wall towards the leaflets.
  if (capsule(m, Vec3d(23.0, -2.0, 61.0), Vec3d(14.0, 0.5, 88.0), 6.5, 3.0) < 0.0)
  {
    return PapillaryMuscleAnterolateral;
  }
  if (capsule(m, Vec3d(1.0, 21.0, 62.0), Vec3d(2.0, 11.0, 89.0), 6.5, 3.0) < 0.0)
  {
    return PapillaryMusclePosteromedial;
  }
  const ValveSide side = valveSide(mitralOf(shape), p);
  return side == ValveSide::Leaflet ? MitralValve : side == ValveSide::Atrium ? LeftAtriumBlood : LeftVentricleBlood;
}

ThoraxLabel rightBlood(const Vec3d& p, const HeartShape& shape)
{
  const Vec3d m = p + Vec3d(shape.rightwardMm(), 0.0, 0.0);
  // The moderator band, from the septum to the free wall, carries the anterior papillary muscle.
  if (capsule(m, Vec3d(-21.0, -2.0, 62.0), Vec3d(-52.0, -9.0, 72.0), 3.5, 3.0) < 0.0)
  {
    return PapillaryMuscleRight;
  }
  const ValveSide side = valveSide(tricuspidOf(shape), p);
  return side == ValveSide::Leaflet  ? TricuspidValve
         : side == ValveSide::Atrium ? RightAtriumBlood
                                     : RightVentricleBlood;
}

/// Whether a point of the left ventricle's wall has the right ventricle on its other side.
bool facesRightVentricle(const HeartSurfaces& f, const Vec3d& p, const HeartShape& shape)
{
  const Vec3d fromAxis(p.x - 5.0, p.y + 0.5, 0.0);
  const Vec3d onEpicardium = p - f.leftEpicardium * fromAxis / std::max(glm::length(fromAxis), 1.0);
  return rightEllipsoid(onEpicardium, shape, 1.0) < 0.0;
}

ThoraxLabel wall(const HeartSurfaces& f, const Vec3d& p, const HeartShape& shape)
{
  const bool leftAtrium = f.leftAtrium < atrialWallMm;
  const bool rightAtrium = f.rightAtrium < atrialWallMm;
  if (f.leftEpicardium < 0.0)
  {
    return facesRightVentricle(f, p, shape) ? InterventricularSeptum : LeftVentricleMyocardium;
  }
  if (f.rightEpicardium < 0.0)
  {
    return RightVentricleMyocardium;
  }
  if (f.leftAtrium + f.rightAtrium < 6.0)
  {
    return InteratrialSeptum;
  }
  return leftAtrium ? LeftAtriumWall : rightAtrium ? RightAtriumWall : Background;
}

/// Distance from the pericardium's inner surface; the blend leaves epicardial fat in the grooves.
double pericardialSac(const HeartSurfaces& f)
{
  const double ventricles = smoothUnion(f.leftEpicardium, f.rightEpicardium, 8.0);
  const double atria = smoothUnion(f.leftAtrium, f.rightAtrium, 10.0) - atrialWallMm;
  return smoothUnion(ventricles, atria, 14.0) - 0.8;
}

} // namespace

HeartSample sampleHeart(const Vec3d& point, const HeartShape& shape)
{
  const Vec3d p = warped(point);
  const HeartSurfaces f = heartSurfaces(p, shape);
  const double sac = pericardialSac(f);
  HeartSample sample;
  sample.outsideMm = sac - pericardiumMm;
  if (sample.outsideMm > 0.0)
  {
    return sample;
  }
  if (std::min(f.leftVentricle, f.leftAtrium) < 0.0)
  {
    sample.label = leftBlood(f, p, shape);
  }
  else if (std::min(f.rightVentricle, f.rightAtrium) < 0.0)
  {
    sample.label = rightBlood(p, shape);
  }
  else
  {
    sample.label = wall(f, p, shape);
  }
  if (sample.label == Background)
  {
    sample.label = sac > 0.0 ? Pericardium : MediastinalFat;
  }
  return sample;
}

HeartPoints heartPoints(const HeartShape& shape)
{
  // The point of the frame that `warped` takes to p.
  const auto unwarped = [](const Vec3d& p) {
    Vec3d q = p;
    for (int i = 0; i < 30; ++i)
    {
      q += p - warped(q);
    }
    return q;
  };
  HeartPoints points{};
  points.apex = unwarped(leftVentricleCentre - Vec3d(0.0, 0.0, leftVentricleRadii(shape).z));
  points.mitral = unwarped(mitralCentre);
  points.tricuspid = unwarped(besideLeft(tricuspidCentre, shape));
  points.mitralRadiusMm = mitralOf(shape).annulusRadiusMm;
  points.tricuspidRadiusMm = tricuspidOf(shape).annulusRadiusMm;
  points.aorticRadiusMm = outflowRadiusMm;
  points.leftVentricle = unwarped(leftVentricleCentre);
  points.rightVentricle = unwarped(besideLeft(rightVentricleCentre, shape));
  points.leftAtrium = unwarped(leftAtriumCentre(shape));
  points.rightAtrium = unwarped(rightAtriumCentre(shape));
  return points;
}

Vec3d aorticValveCentreMm()
{
  return aorticCentre;
}

Vec3d aorticFlowDirection()
{
  return glm::normalize(aorticCentre - outflowStart);
}

Vec3d heartSphereCentreMm()
{
  return Vec3d(-20.0, -3.0, 92.0);
}

double heartSphereRadiusMm(const HeartShape& shape)
{
  const double largest =
    std::max({ 1.0, shape.leftScale, shape.rightScale, shape.leftAtriumScale, shape.rightAtriumScale });
  return 84.0 + 60.0 * (largest - 1.0) + std::max(shape.rightwardMm(), 0.0);
}

} // namespace sono
