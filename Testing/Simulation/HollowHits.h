#pragma once

#include "KernelScene.h"

#include <string>
#include <vector>

namespace sono::test {

/// A ball of label 1 in label 0 and what is in it. Radii in mean voxels.
struct RoundBody
{
  std::string name;
  double radius;
  double inner; ///< of what is in it; 0: nothing; below: all but the voxels that have a face on the outside
  int core;     ///< its label: 0, as outside, or 2
  Vec3d spacing;
};

/// How paths turn at its surfaces.
struct Turning
{
  InterfaceModel model;
  double lobeDegrees; ///< of Amadou2024
  double roughness;   ///< of Acoustic: rms height over correlation length
};

/// Solid and hollow balls, two of them with thin walls and two with walls of one voxel, in isotropic and 3:1 voxels.
std::vector<RoundBody> roundBodies();

/// Mirrors, lobes up to 45 degrees, and rough surfaces up to the steepest.
std::vector<Turning> allTurnings();

/// What paths met. A voxel is a length of one where each axis counts in its own edges.
struct RoundHits
{
  int hits = 0;
  int off = 0;        ///< farther than a voxel from the true surface
  double worst = 0.0; ///< of these distances, voxels
  int through = 0;    ///< at the end of a way that leads more than a voxel deep through another tissue
  int away = 0;       ///< ways from the ball's outside that go away from it by more than 3 degrees
  int again = 0;      ///< of these, those that meet it all the same
};

/// Follows paths from outside through the ball, up to 8 boundaries each, until they have met `hits`. The truth is not
/// made of what the tracer reads: balls are the formula from which the voxels were made, and of walls of one voxel,
/// which are nothing but voxels, each face between two labels is looked at. The ways are sampled every 0.2 voxels.
RoundHits meetRoundBody(const RoundBody& body, const Turning& turning, int hits);

} // namespace sono::test
