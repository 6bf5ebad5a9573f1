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

double outlineScale(double z)
{
  return 1.0 - 0.08 * smoothStep(20.0, 150.0, z) - 0.02 * smoothStep(-60.0, -140.0, z);
}

double halfWidthAt(const ChestShape& chest, double z)
{
  return halfWidthMm * chest.scale * outlineScale(z) + chest.extraFatMm;
}

double halfDepthAt(const ChestShape& chest, double z)
{
  return halfDepthMm * chest.scale * outlineScale(z) + chest.extraFatMm;
}

constexpr double meanFatMm = skinMm + 5.5;
constexpr double mostSagMm = 1.5;

bool isFat(const WallPoint& w, const ChestHeight& height)
{
  constexpr double wavesMm = 0.8;
  if (w.depthMm < meanFatMm - wavesMm || w.depthMm >= meanFatMm + wavesMm + mostSagMm)
  {
    return w.depthMm < meanFatMm; // without the sine, which takes as long as the rest
  }
  return w.depthMm < meanFatMm + wavesMm * std::sin(3.0 * w.side + 0.04 * height.zMm) + height.sagMm;
}

/// Depth of the pleura: the chest wall is thin at the front and the sides, thick at the back and the shoulders.
double pleuraDepthMm(const WallPoint& w, const ChestHeight& height)
{
  return height.pleuraMm + 11.0 * smoothStep(0.2, 1.0, w.back);
}

/// Heights of the ribs' centre lines: down to the front, then, as cartilage, up to the sternum.
struct RibHeights
{
  double firstMm;
  double climbMm; ///< of each rib beyond the third

  RibHeights(const WallPoint& w, double spacingMm)
    : firstMm(firstRibMm - 4.5 * (ribSpacingMm - spacingMm) + 42.0 * w.back + 14.0 * (1.0 - w.back * w.back))
    , climbMm(w.back < 0.0 ? 13.0 * smoothStep(0.5, 0.05, std::abs(w.side)) : 0.0)
  {
  }
  double of(int rib, double spacingMm) const
  {
    return firstMm - spacingMm * (rib - 1) + climbMm * std::max(rib - 3, 0);
  }
};

/// Of an ellipse.
bool isWithin(double x, double halfX, double y, double halfY)
{
  return x * x / (halfX * halfX) + y * y / (halfY * halfY) < 1.0;
}

/// Of an ellipsoid about the origin.
bool isWithin(const Vec3d& p, const Vec3d& radii)
{
  const Vec3d scaled = p / radii;
  return glm::dot(scaled, scaled) < 1.0;
}

bool isSternum(const Vec3d& p, const WallPoint& w, double middleDepthMm, const ChestHeight& height)
{
  return w.back < 0.0 && height.sternumHalfMm > 0.0 &&
         isWithin(p.x, height.sternumHalfMm, w.depthMm - middleDepthMm, 5.5);
}

ThoraxLabel boneOfWall(const Vec3d& p, const WallPoint& w, double pleuraMm, const ChestHeight& height,
                       const ChestShape& chest)
{
  const double middleDepthMm = pleuraMm - 5.5;
  if (std::abs(w.depthMm - middleDepthMm) > 6.0)
  {
    return Background;
  }
  if (isSternum(p, w, middleDepthMm, height))
  {
    return Sternum;
  }
  const double across = (w.depthMm - middleDepthMm) / ribHalfThicknessMm;
  if (std::abs(across) > 1.0 || std::abs(p.x) < 8.0)
  {
    return Background;
  }
  const RibHeights heights(w, chest.ribSpacingMm);
  for (int rib = 1; rib <= ribPairs; ++rib)
  {
    const double along =
      (p.z - heights.of(rib, chest.ribSpacingMm)) * 0.94 / ribHalfHeightMm; // 0.94: cosine of the mean slope
    if (along * along + across * across > 1.0)
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

ThoraxLabel spine(const Vec3d& p, const ChestHeight& height)
{
  if (std::abs(p.x) > 28.0 || p.y < 43.0 || p.y > 96.0) // most of the chest
  {
    return Background;
  }
  const double waist = height.vertebraWaistMm;
  if (isWithin(p.x, 6.0, p.y - 81.0, 6.0))
  {
    return SpinalCord;
  }
  const bool body = isWithin(p.x, 18.0 + waist, p.y - 60.0, 15.5 + waist);
  const bool arch = isWithin(p.x, 12.0, p.y - 80.0, 10.0);
  const bool process =
    height.hasProcess && (isWithin(p.x, 4.0, p.y - 86.0, 10.0) || isWithin(p.x, 28.0, p.y - 78.0, 5.0));
  return body || arch || process ? Vertebrae : Background;
}

ThoraxLabel abdomen(const Vec3d& p, double belowDiaphragmMm)
{
  if (belowDiaphragmMm < 4.0)
  {
    return Muscle;
  }
  if (belowDiaphragmMm > 5.0 && isWithin(p - Vec3d(68.0, 5.0, -84.0), Vec3d(42.0, 55.0, 44.0)))
  {
    return Stomach;
  }
  const double liver = smoothUnion(ellipsoid(p - Vec3d(-68.0, 5.0, -75.0), Vec3d(85.0, 90.0, 85.0)),
                                   ellipsoid(p - Vec3d(5.0, -45.0, -75.0), Vec3d(70.0, 50.0, 42.0)), 25.0);
  return liver < 0.0 ? Liver : VisceralFat;
}

/// The cardiac notch: between the apex, the right ventricle and the chest wall there is no lung. `q` lies in the
/// heart's frame.
bool isNotch(const Vec3d& q, double lungOverlapMm)
{
  static const Ellipsoid front(Vec3d(-40.0, -5.0, 50.0), Vec3d(60.0, 42.0, 42.0));
  constexpr double blendMm = 10.0;
  constexpr double mostMm = 0.25 * blendMm; // in which a union may lie beyond its shapes
  // Most of the lung, at a glance: boxes around the shapes.
  const bool isBehind = q.z < -25.0 - mostMm || q.z > 62.0 + 41.0 + mostMm || std::abs(q.y) > 42.0 + 5.0 + mostMm ||
                        q.x < -40.0 - 60.0 * (1.0 + mostMm / 42.0) || q.x > 4.0 + 41.0 + mostMm;
  return !isBehind && smoothUnion(capsule(q, Vec3d(0.0, 0.0, 0.0), Vec3d(4.0, 0.0, 62.0), 25.0, 41.0),
                                  front.distance(q), blendMm) < -lungOverlapMm;
}

ChestPlace mediastinumOrLung(const Vec3d& p, const Vec3d& q, const ChestHeight& height, const ChestShape& chest)
{
  const double asideMm = p.x > 3.0 ? height.lungAsideMm * smoothStep(-20.0, -60.0, p.y) : 0.0;
  const double halfWidth = 7.0 + 25.0 * smoothStep(-75.0, -10.0, p.y) - 6.0 * smoothStep(35.0, 60.0, p.y) + asideMm;
  const double fromMiddle = std::abs(p.x - 3.0);
  const bool isHilum = isWithin(Vec3d(fromMiddle, p.y, p.z) - Vec3d(38.0, 14.0, 42.0), Vec3d(30.0, 24.0, 30.0));
  if (fromMiddle < halfWidth + height.wavesMm || isHilum || isNotch(q, chest.lungOverlapMm))
  {
    return { MediastinalFat, ChestPlace::All, 0.0 };
  }
  return { p.x > 3.0 ? LungLeft : LungRight, ChestPlace::All, 2.0 + asideMm };
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

ChestHeight chestHeight(double z, const ChestShape& chest)
{
  constexpr double perVertebra = 2.0 * 3.14159265358979 / 25.0; // one each 25 mm
  ChestHeight height{};
  height.zMm = z;
  height.halfWidthMm = halfWidthAt(chest, z);
  height.halfDepthMm = halfDepthAt(chest, z);
  height.sagMm = mostSagMm * smoothStep(-20.0, -110.0, z);
  height.pleuraMm = 17.0 + 26.0 * smoothStep(35.0, 140.0, z);
  height.sternumHalfMm =
    z > -58.0 && z < 98.0 ? 15.0 + 7.0 * smoothStep(55.0, 90.0, z) - 7.0 * smoothStep(-25.0, -55.0, z) : 0.0;
  height.vertebraWaistMm = 1.3 * std::cos(perVertebra * z);
  height.hasProcess = std::cos(perVertebra * (z + 8.0)) > -0.2;
  height.wavesMm = 2.0 * std::sin(0.06 * z);
  height.lungAsideMm = chest.lungAsideMm * smoothStep(100.0, 70.0, z);
  return height;
}

/// Right dome, left dome and the central tendon below the heart.
double diaphragmMm(double px, double py)
{
  const auto dome = [=](double x, double y, double top) {
    return top - 0.012 * ((px - x) * (px - x) + 0.8 * (py - y) * (py - y));
  };
  const double domes = -smoothUnion(-dome(-58.0, -10.0, -4.0), -dome(66.0, 12.0, -24.0), 12.0);
  return -smoothUnion(-domes, -dome(12.0, -50.0, -40.0), 12.0) + 1.5 * std::sin(0.05 * px + 0.04 * py);
}

ThoraxLabel ChestPlace::with(const HeartSample& heart) const
{
  const bool isWall = heart.label != Background && heart.label != Pericardium;
  if (heartBefore == Nothing || (heartBefore == Walls && !isWall))
  {
    return label;
  }
  if (heart.label != Background)
  {
    return heart.label;
  }
  return heart.outsideMm < fatWithinMm ? MediastinalFat : label;
}

ChestPlace chestAt(const Vec3d& p, const WallPoint& wall, const ChestHeight& height, double diaphragmMm,
                   const Vec3d& inHeartFrame, const ChestShape& chest)
{
  WallPoint w = wall;
  if (w.depthMm < skinMm)
  {
    return { w.depthMm < 0.0 ? Background : Skin, ChestPlace::Nothing, 0.0 };
  }
  w.depthMm -= chest.extraFatMm; // the lean body lies below
  if (isFat(w, height))
  {
    return { SubcutaneousFat, ChestPlace::Nothing, 0.0 };
  }
  const double pleuraMm = pleuraDepthMm(w, height);
  if (const ThoraxLabel bone = boneOfWall(p, w, pleuraMm, height, chest))
  {
    return { bone, ChestPlace::Walls, 0.0 };
  }
  const double spineBackMm = halfDepthMm * (chest.scale - 1.0);
  if (const ThoraxLabel vertebra = spine(p - Vec3d(0.0, spineBackMm, 0.0), height))
  {
    return { vertebra, ChestPlace::All, 0.0 };
  }
  if (w.depthMm < pleuraMm)
  {
    return { Muscle, ChestPlace::All, 0.0 };
  }
  const Vec3d raised = p + Vec3d(0.0, 0.0, chest.diaphragmDownMm);
  const double belowDiaphragmMm = diaphragmMm - raised.z;
  return belowDiaphragmMm > 0.0 ? ChestPlace{ abdomen(raised, belowDiaphragmMm), ChestPlace::All, 0.0 }
                                : mediastinumOrLung(p, inHeartFrame, height, chest);
}

double skinDepthMm(const Vec3d& p, const ChestShape& chest)
{
  return wallPoint(p.x, p.y, halfWidthAt(chest, p.z), halfDepthAt(chest, p.z)).depthMm;
}

} // namespace sono
