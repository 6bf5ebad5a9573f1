#include "Phantoms/ThoraxHeart.h"

#include "Core/Simd.h"
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
constexpr double annulusHalfMm = 8.0; // of the tube through a valve's annulus, along it

/// The right heart, shifted to make room for the left one.
Vec3d besideLeft(const Vec3d& p, const HeartShape& shape)
{
  return p - Vec3d(shape.rightwardMm(), 0.0, 0.0);
}

/// Opens or closes a valve that is given half open: the leaflets keep their length, so that a closed one is flatter; a
/// wide ring's stretch to meet.
HeartValve opened(HeartValve valve, double opening)
{
  const double narrowing = valve.annulusRadiusMm - valve.tipRadiusMm;
  const double length2 = valve.heightMm * valve.heightMm + narrowing * narrowing;
  valve.tipRadiusMm *= opening / 0.4;
  const double narrowed = valve.annulusRadiusMm - valve.tipRadiusMm;
  const double leastMm = 0.3 * valve.annulusRadiusMm;
  valve.heightMm = std::sqrt(std::max(length2 - narrowed * narrowed, leastMm * leastMm));
  return valve;
}

HeartValve mitralOf(const HeartShape& shape)
{
  const double size = std::sqrt(shape.leftScale);
  return opened({ mitralCentre, mitralRadiusMm * size, 6.5 * size, 15.0, Vec3d(2.5, 1.0, 0.0) }, shape.valveOpening);
}

HeartValve tricuspidOf(const HeartShape& shape)
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

ValveSide valveSide(const HeartValve& valve, const Vec3d& p)
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
double annulusTube(const HeartValve& valve, const Vec3d& p, double apicalMm, double atrialMm)
{
  const Vec3d q = p - valve.centreMm;
  const double radial = std::sqrt(q.x * q.x + q.y * q.y) - valve.annulusRadiusMm;
  return std::max({ radial, -q.z - apicalMm, q.z - atrialMm });
}

constexpr double mostWarpMm = 1.81; // of what follows

/// Low-frequency irregularity, below 1 mm along each axis: no wall is a perfect ellipsoid.
Vec3d warped(const Vec3d& p)
{
  return p + Vec3d(0.9 * sine(0.11 * p.z + 0.06 * p.y) + 0.5 * sine(0.17 * p.z + 1.0),
                   0.9 * sine(0.10 * p.z - 0.08 * p.x + 2.0), 0.7 * sine(0.09 * p.x + 0.10 * p.y + 0.5));
}

const Vec3d rightVentricleCentre(-18.0, -3.0, 85.0);

/// The right ventricle's long axis goes from the apex, close to the septum, to the tricuspid annulus.
const Vec3d rightLongAxis = glm::normalize(Vec3d(-0.42, -0.08, 0.90));
const Vec3d rightSideAxis = glm::normalize(glm::cross(Vec3d(0.0, 1.0, 0.0), rightLongAxis));
const Vec3d rightDepthAxis = glm::cross(rightLongAxis, rightSideAxis);

/// Anterolateral and posteromedial papillary muscles, from the middle of the free wall towards the leaflets; the
/// moderator band, from the septum to the free wall, carries the anterior one of the right ventricle.
double anterolateral(const Vec3d& m)
{
  return capsule(m, Vec3d(23.0, -2.0, 61.0), Vec3d(14.0, 0.5, 88.0), 6.5, 3.0);
}

double posteromedial(const Vec3d& m)
{
  return capsule(m, Vec3d(1.0, 21.0, 62.0), Vec3d(2.0, 11.0, 89.0), 6.5, 3.0);
}

double moderatorBand(const Vec3d& m)
{
  return capsule(m, Vec3d(-21.0, -2.0, 62.0), Vec3d(-52.0, -9.0, 72.0), 3.5, 3.0);
}

} // namespace

constexpr int surfaceCount = 8;

/// Every surface of the heart at one point.
struct Heart::Surfaces
{
  double leftVentricle;   ///< cavity
  double leftEpicardium;  ///< outer surface of the left ventricle and of its outflow tract
  double outflow;         ///< cavity of the outflow tract
  double rightVentricle;  ///< cavity
  double rightEpicardium; ///< outer surface of the right ventricle, continued into the left
  double leftAtrium;      ///< cavity, with the annulus
  double rightAtrium;     ///< cavity, with the annulus
  double sac;             ///< see pericardialSac

  /// Distance from the pericardium's inner surface; the blend leaves epicardial fat in the grooves.
  double pericardialSac() const
  {
    const double ventricles = smoothUnion(leftEpicardium, rightEpicardium, 8.0);
    const double atria = smoothUnion(leftAtrium, rightAtrium, 10.0) - atrialWallMm;
    return smoothUnion(ventricles, atria, 14.0) - 0.8;
  }
};

Heart::Heart(const HeartShape& shape)
  : shape_(shape)
  , sphereRadiusMm_(heartSphereRadiusMm(shape))
  , rightwardMm_(shape.rightwardMm())
  , mitral_(mitralOf(shape))
  , tricuspid_(tricuspidOf(shape))
  , leftVentricle_(leftVentricleCentre, leftVentricleRadii(shape))
  , leftEpicardium_(Vec3d(5.5, -0.5, 87.0), leftVentricleRadii(shape) + (shape.wallMm / 10.0) * Vec3d(10.0, 9.5, 6.5))
  , leftAtrium_(leftAtriumCentre(shape), shape.leftAtriumScale * Vec3d(25.0, 25.0, 17.5))
  , rightAtrium_(rightAtriumCentre(shape), shape.rightAtriumScale * Vec3d(28.0, 26.0, 22.0))
  , outflow_(outflowStart, aorticCentre, outflowRadiusMm)
  , perGrown_(Vec3d(22.0, 24.0, 56.0) / leftVentricleRadii(shape))
{
  const Vec3d radii = shape.rightScale * Vec3d(44.0, 37.0, 44.0);
  rightVentricle_ = Ellipsoid(Vec3d(0.0), radii);
  rightOfSeptum_ = Ellipsoid(Vec3d(0.0), radii + 1.0);
  rightEpicardium_ = Ellipsoid(Vec3d(0.0), radii + 4.0);
}

inline void Heart::addLeftVentricle(Surfaces& f, const Vec3d& p) const
{
  // Trabeculae: a ripple of the endocardium that fades towards the base.
  const double ripple = 0.5 * sine(0.45 * p.z + 0.3 * p.y) * smoothStep(105.0, 75.0, p.z);
  const double inner = leftVentricle_.distance(p) + ripple;
  const double outer = leftEpicardium_.distance(p);
  f.outflow = outflow_.distance(p);
  f.leftVentricle = smoothUnion(smoothIntersection(inner, p.z - 108.5, 8.0), f.outflow, 4.0);
  f.leftEpicardium = smoothUnion(smoothIntersection(outer, p.z - 114.5, 5.0), f.outflow - 3.5, 3.0);
}

/// The right ventricle is an ellipsoid that reaches into the left ventricle, which cuts a crescent out of it.
inline Vec3d Heart::inRightVentricle(const Vec3d& p) const
{
  const Vec3d q = p - rightVentricleCentre + Vec3d(rightwardMm_, 0.0, 0.0);
  return { glm::dot(q, rightSideAxis), glm::dot(q, rightDepthAxis), glm::dot(q, rightLongAxis) };
}

inline void Heart::addRightVentricle(Surfaces& f, const Vec3d& p) const
{
  const double ripple = 0.6 * sine(0.5 * p.z - 0.35 * p.x) * smoothStep(100.0, 65.0, p.z);
  const Vec3d local = inRightVentricle(p);
  const double inner = rightVentricle_.distance(local) + ripple;
  f.rightVentricle = smoothIntersection(smoothIntersection(inner, p.z - 101.5, 6.0), -f.leftEpicardium, 4.0);
  f.rightEpicardium = smoothIntersection(rightEpicardium_.distance(local), p.z - 107.5, 5.0);
}

inline void Heart::addAtria(Surfaces& f, const Vec3d& p) const
{
  const double aside = 0.5 * rightwardMm_;
  // The bodies are cut by the plane of the interatrial septum; the septum is what is left between them.
  const double left = smoothIntersection(leftAtrium_.distance(p), -20.0 - aside - p.x, 3.0);
  const double right = smoothIntersection(rightAtrium_.distance(p), p.x + 22.5 + aside, 3.0);
  f.leftAtrium = smoothUnion(left, annulusTube(mitral_, p, annulusHalfMm, annulusHalfMm), 3.0);
  f.rightAtrium = smoothUnion(right, annulusTube(tricuspid_, p, annulusHalfMm, annulusHalfMm), 3.0);
  // The outflow tract and its wall pass between the atria.
  f.leftAtrium = smoothIntersection(f.leftAtrium, 3.5 + shape_.apartMm - f.outflow, 2.0);
  f.rightAtrium = smoothIntersection(f.rightAtrium, -f.leftEpicardium, 3.0);
}

inline ThoraxLabel Heart::leftBlood(const Surfaces& f, const Vec3d& p) const
{
  if (f.outflow < 0.0)
  {
    return LeftVentricleBlood;
  }
  // The muscles keep to the wall whatever the size of the cavity.
  const Vec3d m = shape_.leftScale == 1.0 ? p : leftVentricleCentre + (p - leftVentricleCentre) * perGrown_;
  if (anterolateral(m) < 0.0)
  {
    return PapillaryMuscleAnterolateral;
  }
  if (posteromedial(m) < 0.0)
  {
    return PapillaryMusclePosteromedial;
  }
  const ValveSide side = valveSide(mitral_, p);
  return side == ValveSide::Leaflet ? MitralValve : side == ValveSide::Atrium ? LeftAtriumBlood : LeftVentricleBlood;
}

inline ThoraxLabel Heart::rightBlood(const Vec3d& p) const
{
  if (moderatorBand(p + Vec3d(rightwardMm_, 0.0, 0.0)) < 0.0)
  {
    return PapillaryMuscleRight;
  }
  const ValveSide side = valveSide(tricuspid_, p);
  return side == ValveSide::Leaflet  ? TricuspidValve
         : side == ValveSide::Atrium ? RightAtriumBlood
                                     : RightVentricleBlood;
}

/// Whether a point of the left ventricle's wall has the right ventricle on its other side.
inline bool Heart::facesRightVentricle(const Surfaces& f, const Vec3d& p) const
{
  const Vec3d fromAxis(p.x - 5.0, p.y + 0.5, 0.0);
  const Vec3d onEpicardium = p - f.leftEpicardium * fromAxis / std::max(glm::length(fromAxis), 1.0);
  return rightOfSeptum_.distance(inRightVentricle(onEpicardium)) < 0.0;
}

inline ThoraxLabel Heart::wall(const Surfaces& f, const Vec3d& p) const
{
  const bool leftAtrium = f.leftAtrium < atrialWallMm;
  const bool rightAtrium = f.rightAtrium < atrialWallMm;
  if (f.leftEpicardium < 0.0)
  {
    return facesRightVentricle(f, p) ? InterventricularSeptum : LeftVentricleMyocardium;
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

/// `p` is warped.
inline Heart::Surfaces Heart::surfacesAt(const Vec3d& p) const
{
  Surfaces f{};
  addLeftVentricle(f, p);
  addRightVentricle(f, p);
  addAtria(f, p);
  f.sac = f.pericardialSac();
  return f;
}

inline HeartSample Heart::sampleOf(const Surfaces& f, const Vec3d& p) const
{
  HeartSample sample;
  sample.outsideMm = f.sac - pericardiumMm;
  if (sample.outsideMm > 0.0)
  {
    return sample;
  }
  if (std::min(f.leftVentricle, f.leftAtrium) < 0.0)
  {
    sample.label = leftBlood(f, p);
  }
  else if (std::min(f.rightVentricle, f.rightAtrium) < 0.0)
  {
    sample.label = rightBlood(p);
  }
  else
  {
    sample.label = wall(f, p);
  }
  if (sample.label == Background)
  {
    sample.label = f.sac > 0.0 ? Pericardium : MediastinalFat;
  }
  return sample;
}

SONO_SIMD_CLONES __attribute__((flatten)) HeartSample Heart::sample(const Vec3d& point) const
{
  const Vec3d p = warped(point);
  return sampleOf(surfacesAt(p), p);
}

SONO_SIMD_CLONES __attribute__((flatten)) void Heart::sampleEach(const Vec3d* points, int count,
                                                                 HeartSample* samples) const
{
  constexpr int together = 16;
  const Heart own = *this; // what may be read at any time needs no branch
  double x[together];
  double y[together];
  double z[together];
  double of[surfaceCount][together];
  for (int first = 0; first < count; first += together)
  {
    const int here = std::min(together, count - first);
    for (int n = 0; n < together; ++n)
    {
      const Vec3d& point = points[first + std::min(n, here - 1)];
      x[n] = point.x;
      y[n] = point.y;
      z[n] = point.z;
    }
    for (int n = 0; n < together; ++n)
    {
      const Vec3d p = warped(Vec3d(x[n], y[n], z[n]));
      const Surfaces f = own.surfacesAt(p);
      x[n] = p.x;
      y[n] = p.y;
      z[n] = p.z;
      of[0][n] = f.leftVentricle;
      of[1][n] = f.leftEpicardium;
      of[2][n] = f.outflow;
      of[3][n] = f.rightVentricle;
      of[4][n] = f.rightEpicardium;
      of[5][n] = f.leftAtrium;
      of[6][n] = f.rightAtrium;
      of[7][n] = f.sac;
    }
    for (int n = 0; n < here; ++n)
    {
      const Surfaces f{ of[0][n], of[1][n], of[2][n], of[3][n], of[4][n], of[5][n], of[6][n], of[7][n] };
      samples[first + n] = sampleOf(f, Vec3d(x[n], y[n], z[n]));
    }
  }
}

DistanceBounds Heart::outsideMm(const Vec3d& p, double aroundMm) const
{
  const double r = aroundMm + mostWarpMm;
  const Vec3d local = inRightVentricle(p);
  // A smooth union lies up to a quarter of its width below the nearer shape, a smooth intersection above the farther.
  const auto tube = [&](const HeartValve& valve) {
    const double z = std::abs(p.z - valve.centreMm.z) - annulusHalfMm;
    const double x = p.x - valve.centreMm.x;
    const double y = p.y - valve.centreMm.y;
    return std::max(z, std::sqrt(x * x + y * y) - valve.annulusRadiusMm) - r;
  };
  const double leftWall =
    std::min(std::max(leftEpicardium_.leastAround(p, r), p.z - r - 114.5), outflow_.distance(p) - r - 3.5) - 0.25 * 3.0;
  const double rightWall = std::max(rightEpicardium_.leastAround(local, r), p.z - r - 107.5);
  const double atria = std::min(std::min(leftAtrium_.leastAround(p, r), tube(mitral_)),
                                std::min(rightAtrium_.leastAround(p, r), tube(tricuspid_))) -
                       0.25 * 3.0 - 0.25 * 10.0 - atrialWallMm;
  const double least = std::min(std::min(leftWall, rightWall) - 0.25 * 8.0, atria) - 0.25 * 14.0;
  const double most = std::min(std::max(leftEpicardium_.mostAround(p, r), p.z + r - 114.5),
                               std::max(rightEpicardium_.mostAround(local, r), p.z + r - 107.5)) +
                      0.25 * 5.0;
  return { least - 0.8 - pericardiumMm, most - 0.8 - pericardiumMm };
}

bool Heart::isNear(const Vec3d& p) const
{
  const Vec3d from = p - heartSphereCentreMm();
  return glm::dot(from, from) < sphereRadiusMm_ * sphereRadiusMm_;
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
