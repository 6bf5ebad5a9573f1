#include "Phantoms/ThoraxChest.h"

#include "Phantoms/ThoraxShapes.h"

namespace sono {

using namespace shapes;

namespace {

constexpr double halfWidthMm = 143.0;
constexpr double halfDepthMm = 103.0;
constexpr double bottomMm = -120.0;
constexpr double topMm = 130.0;

constexpr double skinMm = 2.0;
constexpr double ribHalfHeightMm = 6.0;
constexpr double ribHalfThicknessMm = 4.0;
constexpr double ribSpacingMm = 29.0;
constexpr double firstRibMm = 121.5; ///< height of rib 1 at the torso's side
constexpr int ribPairs = 10;

/// Outline of the torso at one height: the curve X^4 + c X^2 Y^2 + Y^4 = 1 with X = x/a, Y = y/b, between an ellipse
/// (c = 2) and a rounded box (c = 0).
constexpr double outlineBlend = 1.3;

double outlineScale(double z)
{
  return 1.0 - 0.08 * smoothStep(20.0, 150.0, z) - 0.02 * smoothStep(-60.0, -140.0, z);
}

double outlineRadius(double x, double y)
{
  const double x2 = x * x;
  const double y2 = y * y;
  return std::sqrt(std::sqrt(x2 * x2 + outlineBlend * x2 * y2 + y2 * y2));
}

double halfWidthAt(const ChestShape& chest, double z)
{
  return halfWidthMm * chest.scale * outlineScale(z) + chest.extraFatMm;
}

double halfDepthAt(const ChestShape& chest, double z)
{
  return halfDepthMm * chest.scale * outlineScale(z) + chest.extraFatMm;
}

/// A point as the chest wall sees it.
struct WallPoint
{
  double depthMm; ///< below the skin's outer surface
  double side;    ///< -1 right, 1 left: x on the outline of the same direction
  double back;    ///< -1 front, 1 back
};

WallPoint wallPoint(const Vec3d& p, const ChestShape& chest)
{
  const double a = halfWidthAt(chest, p.z);
  const double b = halfDepthAt(chest, p.z);
  const double x = p.x / a;
  const double y = p.y / b;
  const double r = std::max(outlineRadius(x, y), 1e-6);
  const double x1 = x / r;
  const double y1 = y / r;
  // Distance to the outline's tangent where the point's radius meets it.
  const double slopeX = (2.0 * x1 * x1 * x1 + outlineBlend * x1 * y1 * y1) / (2.0 * a);
  const double slopeY = (2.0 * y1 * y1 * y1 + outlineBlend * y1 * x1 * x1) / (2.0 * b);
  return { (1.0 - r) / std::sqrt(slopeX * slopeX + slopeY * slopeY), x1, y1 };
}

bool isFat(const Vec3d& p, const WallPoint& w)
{
  constexpr double meanMm = skinMm + 5.5;
  constexpr double wavesMm = 0.8;
  constexpr double sagMm = 1.5;
  if (w.depthMm < meanMm - wavesMm || w.depthMm >= meanMm + wavesMm + sagMm)
  {
    return w.depthMm < meanMm; // without the sine, which takes as long as the rest
  }
  return w.depthMm < meanMm + wavesMm * std::sin(3.0 * w.side + 0.04 * p.z) + sagMm * smoothStep(-20.0, -110.0, p.z);
}

/// Depth of the pleura: the chest wall is thin at the front and the sides, thick at the back and the shoulders.
double pleuraDepthMm(const Vec3d& p, const WallPoint& w)
{
  return 17.0 + 26.0 * smoothStep(35.0, 140.0, p.z) + 11.0 * smoothStep(0.2, 1.0, w.back);
}

/// Height of a rib's centre line: down to the front, then, as cartilage, up to the sternum.
double ribHeightMm(int rib, const WallPoint& w, double spacingMm)
{
  const double bone = firstRibMm - 4.5 * (ribSpacingMm - spacingMm) - spacingMm * (rib - 1) + 42.0 * w.back +
                      14.0 * (1.0 - w.back * w.back);
  const double climb = w.back < 0.0 ? 13.0 * std::max(rib - 3, 0) * smoothStep(0.5, 0.05, std::abs(w.side)) : 0.0;
  return bone + climb;
}

/// Of an ellipse.
bool isWithin(double x, double halfX, double y, double halfY)
{
  return x * x / (halfX * halfX) + y * y / (halfY * halfY) < 1.0;
}

bool isSternum(const Vec3d& p, const WallPoint& w, double middleDepthMm)
{
  const double halfWidth = 15.0 + 7.0 * smoothStep(55.0, 90.0, p.z) - 7.0 * smoothStep(-25.0, -55.0, p.z);
  return w.back < 0.0 && p.z > -58.0 && p.z < 98.0 && isWithin(p.x, halfWidth, w.depthMm - middleDepthMm, 5.5);
}

ThoraxLabel boneOfWall(const Vec3d& p, const WallPoint& w, double pleuraMm, const ChestShape& chest)
{
  const double middleDepthMm = pleuraMm - 5.5;
  if (std::abs(w.depthMm - middleDepthMm) > 6.0)
  {
    return Background;
  }
  if (isSternum(p, w, middleDepthMm))
  {
    return Sternum;
  }
  const double across = (w.depthMm - middleDepthMm) / ribHalfThicknessMm;
  for (int rib = 1; rib <= ribPairs; ++rib)
  {
    const double along =
      (p.z - ribHeightMm(rib, w, chest.ribSpacingMm)) * 0.94 / ribHalfHeightMm; // 0.94: cosine of the mean slope
    if (along * along + across * across > 1.0 || std::abs(p.x) < 8.0)
    {
      continue;
    }
    const bool cartilage = w.back < 0.0 && std::abs(w.side) < 0.46;
    if (cartilage && rib > 7 && std::abs(w.side) < 0.25)
    {
      continue; // ribs 8 to 10 do not reach the sternum
    }
    return cartilage ? CostalCartilages : ThoraxLabel((p.x > 0.0 ? RibLeft1 : RibRight1) + rib - 1);
  }
  return Background;
}

ThoraxLabel spine(const Vec3d& p)
{
  if (std::abs(p.x) > 28.0 || p.y < 43.0 || p.y > 96.0) // most of the chest
  {
    return Background;
  }
  const double waist = 1.3 * std::cos(2.0 * 3.14159265358979 * p.z / 25.0); // one vertebra each 25 mm
  if (isWithin(p.x, 6.0, p.y - 81.0, 6.0))
  {
    return SpinalCord;
  }
  const bool body = isWithin(p.x, 18.0 + waist, p.y - 60.0, 15.5 + waist);
  const bool arch = isWithin(p.x, 12.0, p.y - 80.0, 10.0);
  const bool level = std::cos(2.0 * 3.14159265358979 * (p.z + 8.0) / 25.0) > -0.2;
  const bool process = level && (isWithin(p.x, 4.0, p.y - 86.0, 10.0) || isWithin(p.x, 28.0, p.y - 78.0, 5.0));
  return body || arch || process ? Vertebrae : Background;
}

/// Height of the diaphragm's upper surface: right dome, left dome and the central tendon below the heart.
double diaphragmMm(const Vec3d& p)
{
  const auto dome = [&p](double x, double y, double top) {
    return top - 0.012 * ((p.x - x) * (p.x - x) + 0.8 * (p.y - y) * (p.y - y));
  };
  const double domes = -smoothUnion(-dome(-58.0, -10.0, -4.0), -dome(66.0, 12.0, -24.0), 12.0);
  return -smoothUnion(-domes, -dome(12.0, -50.0, -40.0), 12.0) + 1.5 * std::sin(0.05 * p.x + 0.04 * p.y);
}

ThoraxLabel abdomen(const Vec3d& p, double belowDiaphragmMm)
{
  if (belowDiaphragmMm < 4.0)
  {
    return Muscle;
  }
  if (belowDiaphragmMm > 5.0 && ellipsoid(p - Vec3d(68.0, 5.0, -84.0), Vec3d(42.0, 55.0, 44.0)) < 0.0)
  {
    return Stomach;
  }
  const double liver = smoothUnion(ellipsoid(p - Vec3d(-68.0, 5.0, -75.0), Vec3d(85.0, 90.0, 85.0)),
                                   ellipsoid(p - Vec3d(5.0, -45.0, -75.0), Vec3d(70.0, 50.0, 42.0)), 25.0);
  return liver < 0.0 ? Liver : VisceralFat;
}

ThoraxLabel mediastinumOrLung(const Vec3d& p, const HeartSample& heart, const Vec3d& q, const ChestShape& chest)
{
  const double asideMm =
    p.x > 3.0 ? chest.lungAsideMm * smoothStep(-20.0, -60.0, p.y) * smoothStep(100.0, 70.0, p.z) : 0.0;
  const double halfWidth = 7.0 + 25.0 * smoothStep(-75.0, -10.0, p.y) - 6.0 * smoothStep(35.0, 60.0, p.y) + asideMm;
  const auto isMediastinum = [&] { return std::abs(p.x - 3.0) < halfWidth + 2.0 * std::sin(0.06 * p.z); };
  const auto isHilum = [&] {
    return ellipsoid(Vec3d(std::abs(p.x - 3.0), p.y, p.z) - Vec3d(38.0, 14.0, 42.0), Vec3d(30.0, 24.0, 30.0)) < 0.0;
  };
  // The cardiac notch: between the apex, the right ventricle and the chest wall there is no lung.
  const auto notch = [&] {
    return smoothUnion(capsule(q, Vec3d(0.0, 0.0, 0.0), Vec3d(4.0, 0.0, 62.0), 25.0, 41.0),
                       ellipsoid(q - Vec3d(-40.0, -5.0, 50.0), Vec3d(60.0, 42.0, 42.0)), 10.0);
  };
  if (heart.outsideMm < 2.0 + asideMm || isMediastinum() || isHilum() || notch() < -chest.lungOverlapMm)
  {
    return MediastinalFat;
  }
  return p.x > 3.0 ? LungLeft : LungRight;
}

} // namespace

Vec3d thoraxBoxLowMm(const ChestShape& chest)
{
  return Vec3d(-halfWidthAt(chest, 0.0) - 3.0, -halfDepthAt(chest, 0.0) - 3.0, bottomMm);
}

Vec3d thoraxBoxHighMm(const ChestShape& chest)
{
  return Vec3d(halfWidthAt(chest, 0.0) + 3.0, halfDepthAt(chest, 0.0) + 3.0, topMm);
}

Vec3d skinPointMm(const ChestShape& chest, double towardsX, double towardsY, double z)
{
  const double r = outlineRadius(towardsX / halfWidthAt(chest, z), towardsY / halfDepthAt(chest, z));
  return Vec3d(towardsX / r, towardsY / r, z);
}

ThoraxLabel sampleChest(const Vec3d& p, const HeartSample& heart, const Vec3d& inHeartFrame, const ChestShape& chest)
{
  const double spineBackMm = halfDepthMm * (chest.scale - 1.0);
  WallPoint w = wallPoint(p, chest);
  if (w.depthMm < 0.0)
  {
    return Background;
  }
  if (w.depthMm < skinMm)
  {
    return Skin;
  }
  w.depthMm -= chest.extraFatMm; // the lean body lies below
  if (isFat(p, w))
  {
    return SubcutaneousFat;
  }
  const double pleuraMm = pleuraDepthMm(p, w);
  const ThoraxLabel bone = boneOfWall(p, w, pleuraMm, chest);
  const bool isInPericardium = heart.label != Background && heart.label != Pericardium; // where bone would open a wall
  if (bone && !isInPericardium)
  {
    return bone;
  }
  if (heart.label != Background)
  {
    return heart.label;
  }
  if (const ThoraxLabel vertebra = spine(p - Vec3d(0.0, spineBackMm, 0.0)))
  {
    return vertebra;
  }
  if (w.depthMm < pleuraMm)
  {
    return Muscle;
  }
  const Vec3d raised = p + Vec3d(0.0, 0.0, chest.diaphragmDownMm);
  const double belowDiaphragmMm = diaphragmMm(raised) - raised.z;
  return belowDiaphragmMm > 0.0 ? abdomen(raised, belowDiaphragmMm) : mediastinumOrLung(p, heart, inHeartFrame, chest);
}

double skinDepthMm(const Vec3d& p, const ChestShape& chest)
{
  return wallPoint(p, chest).depthMm;
}

} // namespace sono
