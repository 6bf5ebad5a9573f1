#pragma once

#include "Kernel/Vec.h"
#include "Phantoms/ThoraxHeart.h"
#include "Phantoms/ThoraxLabels.h"

#include <algorithm>
#include <cmath>

namespace sono {

/// Which chest.
struct ChestShape
{
  double scale = 1.0;           ///< of width and depth
  double extraFatMm = 0.0;      ///< under the skin, all around
  double ribSpacingMm = 29.0;   ///< from rib to rib
  double lungOverlapMm = 0.0;   ///< how far the lungs' edges come in over the heart
  double diaphragmDownMm = 0.0; ///< how much lower diaphragm, liver and stomach stand
  double lungAsideMm = 0.0;     ///< how far the left lung's front has gone to the left of the middle and off the heart
};

/// Box that holds the torso with a margin of air at its sides; above and below the torso goes on (world LPS mm).
Vec3d thoraxBoxLowMm(const ChestShape& chest);
Vec3d thoraxBoxHighMm(const ChestShape& chest);

/// The point of the skin's outer surface in the horizontal direction (towardsX, towardsY) from the torso's axis at
/// height z.
Vec3d skinPointMm(const ChestShape& chest, double towardsX, double towardsY, double z);

/// What of the torso is the same at one height.
struct ChestHeight
{
  double zMm;
  double halfWidthMm, halfDepthMm; ///< of the outline
  double sagMm;                    ///< by which fat is thicker
  double pleuraMm;                 ///< depth, where the back adds nothing
  double sternumHalfMm;            ///< 0: no sternum
  double vertebraWaistMm;
  bool hasProcess;    ///< of a vertebra
  double wavesMm;     ///< of the mediastinum
  double lungAsideMm; ///< of the left lung, where the front adds nothing
};

ChestHeight chestHeight(double zMm, const ChestShape& chest);

/// Height of the diaphragm's upper surface over a place, of a chest breathed out.
double diaphragmMm(double x, double y);

/// A point as the chest wall sees it.
struct WallPoint
{
  double depthMm; ///< below the skin's outer surface
  double side;    ///< -1 right, 1 left: x on the outline of the same direction
  double back;    ///< -1 front, 1 back
};

/// Outline of the torso at one height: the curve X^4 + c X^2 Y^2 + Y^4 = 1 with X = x/a, Y = y/b, between an ellipse
/// (c = 2) and a rounded box (c = 0).
constexpr double outlineBlend = 1.3;

inline double outlineRadius(double x, double y)
{
  const double x2 = x * x;
  const double y2 = y * y;
  return std::sqrt(std::sqrt(x2 * x2 + outlineBlend * x2 * y2 + y2 * y2));
}

inline WallPoint wallPoint(double px, double py, double halfWidthMm, double halfDepthMm)
{
  const double x = px / halfWidthMm;
  const double y = py / halfDepthMm;
  const double r = std::max(outlineRadius(x, y), 1e-6);
  const double x1 = x / r;
  const double y1 = y / r;
  // Distance to the outline's tangent where the point's radius meets it.
  const double slopeX = (2.0 * x1 * x1 * x1 + outlineBlend * x1 * y1 * y1) / (2.0 * halfWidthMm);
  const double slopeY = (2.0 * y1 * y1 * y1 + outlineBlend * y1 * x1 * x1) / (2.0 * halfDepthMm);
  return { (1.0 - r) / std::sqrt(slopeX * slopeX + slopeY * slopeY), x1, y1 };
}

/// Of `count` points side by side, from px on, `stepMm` apart; what it gives has room for as many.
void wallRow(double px, double stepMm, double py, double halfWidthMm, double halfDepthMm, int count, double* depthMm,
             double* side, double* back);

/// What the chest has at a point, and what of it a heart there takes.
struct ChestPlace
{
  enum Before
  {
    Nothing, ///< of the heart
    Walls,   ///< all but the pericardium, where bone would open a wall
    All
  };
  ThoraxLabel label = Background; ///< where there is no heart
  Before heartBefore = Nothing;
  double fatWithinMm = 0.0; ///< of the heart's surface lung gives way to fat

  ThoraxLabel with(const HeartSample& heart) const;
};

/// @param diaphragmMm as above
/// @param inHeartFrame the point there
ChestPlace chestAt(const Vec3d& p, const WallPoint& wall, const ChestHeight& height, double diaphragmMm,
                   const Vec3d& inHeartFrame, const ChestShape& chest);

/// Depth of a point below the skin's outer surface, negative outside.
double skinDepthMm(const Vec3d& p, const ChestShape& chest);

} // namespace sono
