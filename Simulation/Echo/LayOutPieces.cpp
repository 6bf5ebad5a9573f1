#include "Echo/LayOutPieces.h"

#include "Core/Simd.h"
#include "Echo/ResizeAll.h"

#include <cmath>

namespace sono {

namespace {

/// Of one piece. Extents are half its sides.
struct Extent
{
  Vec3f halfU, halfV;
  float riseMm, turn, blobUMm, blobVMm, blobUPerHalf, blobVPerHalf, diffuseMm2, coherentMm2;
};

inline Extent extentOf(const SurfacePiece& piece, const PieceNet& diffuse, const PieceNet& coherent)
{
  const float u = 0.5f * float(coherent.cutsU) * coherent.stepU;
  const float v = 0.5f * float(coherent.cutsV) * coherent.stepV;
  const float turnU = std::fabs(piece.bendUU) * u + std::fabs(piece.bendUV) * v;
  const float turnV = std::fabs(piece.bendUV) * u + std::fabs(piece.bendVV) * v;
  const float stretch = std::sqrt(1.0f + piece.slopeU * piece.slopeU + piece.slopeV * piece.slopeV) + turnU + turnV;
  const float blobU = float(blobPerStep) * coherent.stepU;
  const float blobV = float(blobPerStep) * coherent.stepV;
  return { fromAlong(piece.axis, piece.slopeU * u, u, 0.0f),
           fromAlong(piece.axis, piece.slopeV * v, 0.0f, v),
           0.5f * (turnU * u + turnV * v),
           turnU + turnV,
           blobU,
           blobV,
           blobU / u,
           blobV / v,
           piece.share * stretch * diffuse.stepU * diffuse.stepV,
           piece.share * stretch * coherent.stepU * coherent.stepV };
}

SONO_SIMD_CLONES __attribute__((flatten)) void layOutEach(PieceShapes& shapes, const PieceNets& givenNets,
                                                          float longestStepMm, PieceList& pieces, PieceExtents& extents)
{
  const PieceNets nets = givenNets;
  const float *slopeU = shapes.slopeU.data(), *slopeV = shapes.slopeV.data();
  const float *bendUU = shapes.bendUU.data(), *bendUV = shapes.bendUV.data(), *bendVV = shapes.bendVV.data();
  const float* share = shapes.share.data();
  const std::int32_t* axis = shapes.axis.data();
  std::int32_t* isCoarsest = shapes.isCoarsest.data();
  float *nx = pieces.normalX.data(), *ny = pieces.normalY.data(), *nz = pieces.normalZ.data();
  float* radius = pieces.radiusMm.data();
  float *ux = extents.uX.data(), *uy = extents.uY.data(), *uz = extents.uZ.data();
  float *vx = extents.vX.data(), *vy = extents.vY.data(), *vz = extents.vZ.data();
  float *rise = extents.riseMm.data(), *turn = extents.turn.data();
  float *blobU = extents.blobUMm.data(), *blobV = extents.blobVMm.data();
  float *perU = extents.blobUPerHalf.data(), *perV = extents.blobVPerHalf.data();
  float *root = extents.diffuseRootMm.data(), *area = extents.coherentMm2.data();
  const int count = inWholeVectors(shapes.count);
#pragma GCC ivdep
  for (int n = 0; n < count; ++n)
  {
    SurfacePiece piece{};
    piece.slopeU = slopeU[n];
    piece.slopeV = slopeV[n];
    piece.bendUU = bendUU[n];
    piece.bendUV = bendUV[n];
    piece.bendVV = bendVV[n];
    piece.share = share[n];
    piece.axis = std::uint8_t(axis[n]);
    const PieceBounds bounds = pieceBounds(piece, longestStepMm);
    const PieceCuts cuts = nets.coherentCuts(piece);
    const Extent extent = extentOf(piece, nets.diffuseNet(piece), cuts.of(piece.axis, nets.spacingMm));
    nx[n] = bounds.normal.x;
    ny[n] = bounds.normal.y;
    nz[n] = bounds.normal.z;
    radius[n] = bounds.radiusMm;
    isCoarsest[n] = nets.isCoarsest(cuts) ? 1 : 0;
    ux[n] = extent.halfU.x;
    uy[n] = extent.halfU.y;
    uz[n] = extent.halfU.z;
    vx[n] = extent.halfV.x;
    vy[n] = extent.halfV.y;
    vz[n] = extent.halfV.z;
    rise[n] = extent.riseMm;
    turn[n] = extent.turn;
    blobU[n] = extent.blobUMm;
    blobV[n] = extent.blobVMm;
    perU[n] = extent.blobUPerHalf;
    perV[n] = extent.blobVPerHalf;
    root[n] = std::sqrt(extent.diffuseMm2);
    area[n] = extent.coherentMm2;
  }
}

} // namespace

void PieceShapes::push(const SurfacePiece& piece)
{
  const std::size_t n = std::size_t(count++);
  if (axis.size() < n + vectorWidth)
  {
    resizeAll({ &slopeU, &slopeV, &bendUU, &bendUV, &bendVV, &share }, 2 * (n + vectorWidth));
    resizeAll({ &axis, &isCoarsest }, 2 * (n + vectorWidth));
  }
  slopeU[n] = piece.slopeU;
  slopeV[n] = piece.slopeV;
  bendUU[n] = piece.bendUU;
  bendUV[n] = piece.bendUV;
  bendVV[n] = piece.bendVV;
  share[n] = piece.share;
  axis[n] = piece.axis;
}

void layOutPieces(PieceShapes& shapes, const PieceNets& nets, float longestStepMm, const SurfaceTable& table,
                  PieceList& pieces, PieceExtents& extents)
{
  extents.reserve(shapes.count);
  layOutEach(shapes, nets, longestStepMm, pieces, extents);
  for (int n = 0; n < shapes.count; ++n)
  {
    pieces.setReach(n, shapes.isCoarsest[std::size_t(n)] != 0, table);
  }
}

} // namespace sono
