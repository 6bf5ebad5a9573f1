// Which of a map's faces become pieces before anybody asks for them (Scene/SurfacePieces.h).
#include "Scene/SurfacePieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace {

using namespace sono;

constexpr int edge = 48;

/// Tissue 1 above a wavy floor between 20 and 28 voxels, 2 below, and a wall of it that stands across at i = 40.
std::vector<std::uint8_t> floorAndWall()
{
  std::vector<std::uint8_t> tissues(edge * edge * edge, 0);
  for (int k = 0; k < edge; ++k)
  {
    for (int j = 0; j < edge; ++j)
    {
      for (int i = 0; i < edge; ++i)
      {
        const bool isBelow = k > 24.0 + 3.0 * std::sin(0.15 * i) || i >= 40;
        tissues[std::size_t(i + edge * (j + edge * k))] = isBelow ? 2 : 1;
      }
    }
  }
  return tissues;
}

struct Fitted
{
  int floor = 0; ///< faces of columns along z
  int wall = 0;  ///< of the wall's columns, along x
};

/// Of the coarse faces of all bricks, those whose piece is there. `stop` ends the fitting at so many questions.
Fitted fittedBeside(const VoxelBox& box, int stop)
{
  const std::vector<std::uint8_t> tissues = floorAndWall();
  const SurfacePieces pieces(tissues.data(), Vec3i(edge), Vec3d(1.0));
  const Vec3i first(1, 1, 4);
  const std::vector<std::uint32_t>& heard = pieces.coarseFaces(first);
  const auto upright =
    std::find_if(heard.begin(), heard.end(), [&](std::uint32_t f) { return pieces.faces(first)[f].axis == 2; });
  EXPECT_NE(upright, heard.end());
  EXPECT_NE(pieces.piece(first, *upright), nullptr);
  int asked = 0;
  pieces.fitBeside(box, [&] { return ++asked <= stop; });
  Fitted count;
  for (int k = 0; k < pieces.bricks().z; ++k)
  {
    for (int j = 0; j < pieces.bricks().y; ++j)
    {
      for (int i = 0; i < pieces.bricks().x; ++i)
      {
        const Vec3i brick(i, j, k);
        for (const std::uint32_t f : pieces.coarseFaces(brick))
        {
          if (pieces.isFitted(brick, f))
          {
            const SurfacePieces::Face& face = pieces.faces(brick)[f];
            count.floor += face.axis == 2 ? 1 : 0;
            count.wall += face.axis == 0 && face.voxel.x == 39 && face.voxel.z < 18 ? 1 : 0;
          }
        }
      }
    }
  }
  return count;
}

TEST(SurfacePieces, WhatGoesOnBesideAPieceIsFittedAheadAndNoWallAcross)
{
  const Fitted all = fittedBeside({ Vec3i(0), Vec3i(edge) }, 1000000);
  // Every second column of the floor's 40 x 48 along each of two axes, slanted by 24 degrees at most.
  EXPECT_GE(all.floor, 20 * 24 * 9 / 10);
  EXPECT_EQ(all.wall, 0);
}

TEST(SurfacePieces, FittingAheadEndsWhenItIsToldTo)
{
  const Fitted few = fittedBeside({ Vec3i(0), Vec3i(edge) }, 10);
  EXPECT_GE(few.floor, 1);
  EXPECT_LE(few.floor, 11);
}

TEST(SurfacePieces, WhatWasHeardElsewhereIsNotGoneOnFrom)
{
  const Fitted none = fittedBeside({ Vec3i(24, 24, 0), Vec3i(edge) }, 1000000);
  EXPECT_EQ(none.floor, 1); // the one that was asked for
}

} // namespace
