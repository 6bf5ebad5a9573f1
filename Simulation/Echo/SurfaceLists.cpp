#include "Echo/SurfaceLists.h"

#include "Core/Simd.h"
#include "Echo/ResizeAll.h"

#include <cstddef>

namespace sono {

namespace {

template<int axis>
inline void layOutAlong(const SurfacePiece& given, const PieceNet& givenNet, int row, int ofPiece, PointList& points)
{
  const PieceNet net = givenNet;
  SurfacePiece piece = given;
  piece.axis = axis;
  const std::ptrdiff_t at = points.count;
  float *x = points.x.data() + at, *y = points.y.data() + at, *z = points.z.data() + at;
  float *nx = points.normalX.data() + at, *ny = points.normalY.data() + at, *nz = points.normalZ.data() + at;
  float *ux = points.uX.data() + at, *uy = points.uY.data() + at, *uz = points.uZ.data() + at;
  float *vx = points.vX.data() + at, *vy = points.vY.data() + at, *vz = points.vZ.data() + at;
  float* area = points.areaMm2.data() + at;
  std::int32_t *rows = points.row.data() + at, *of = points.piece.data() + at;
  const int count = inWholeVectors(net.points());
#pragma GCC ivdep
  for (int n = 0; n < count; ++n)
  {
    const SurfacePoint p = piecePoint(piece, net, n);
    x[n] = p.position.x;
    y[n] = p.position.y;
    z[n] = p.position.z;
    nx[n] = p.normal.x;
    ny[n] = p.normal.y;
    nz[n] = p.normal.z;
    ux[n] = p.tangentU.x;
    uy[n] = p.tangentU.y;
    uz[n] = p.tangentU.z;
    vx[n] = p.tangentV.x;
    vy[n] = p.tangentV.y;
    vz[n] = p.tangentV.z;
    area[n] = p.areaMm2;
    rows[n] = row;
    of[n] = ofPiece;
  }
}

SONO_SIMD_CLONES __attribute__((flatten)) void layOutNet(const SurfacePiece& piece, const PieceNet& net, int row,
                                                         int ofPiece, PointList& points)
{
  switch (piece.axis)
  {
    case 0:
      return layOutAlong<0>(piece, net, row, ofPiece, points);
    case 1:
      return layOutAlong<1>(piece, net, row, ofPiece, points);
    default:
      return layOutAlong<2>(piece, net, row, ofPiece, points);
  }
}

} // namespace

void FaceList::reserve(int more)
{
  resizeAll({ &x, &y, &z, &normalX, &normalY, &normalZ, &cosineBelow, &cosineAbove },
            std::size_t(inWholeVectors(count + more)));
}

void PieceList::place(const Vec3f& position, int rowFromA)
{
  const std::size_t n = std::size_t(count++);
  if (x.size() < n + vectorWidth)
  {
    resizeAll({ &x, &y, &z, &normalX, &normalY, &normalZ, &radiusMm, &reachA, &reachB, &coherentReachA, &coherentReachB,
                &decayPerMmA, &decayPerMmB },
              2 * (n + vectorWidth));
    resizeAll({ &row }, 2 * (n + vectorWidth));
  }
  x[n] = position.x;
  y[n] = position.y;
  z[n] = position.z;
  row[n] = rowFromA;
}

void PieceList::setReach(int piece, bool coarse, const SurfaceTable& table)
{
  const std::size_t n = std::size_t(piece);
  const SurfaceRow& fromA = table.rows[row[n]];
  const SurfaceRow& fromB = table.rows[row[n] ^ 1];
  reachA[n] = fromA.reach;
  reachB[n] = fromB.reach;
  coherentReachA[n] = coarse ? fromA.coherentReach : fromA.finestReach;
  coherentReachB[n] = coarse ? fromB.coherentReach : fromB.finestReach;
  decayPerMmA[n] = fromA.decayPerMm;
  decayPerMmB[n] = fromB.decayPerMm;
}

void PieceList::push(const Vec3f& position, const Vec3f& normal, float radius, bool coarse, int rowFromA,
                     const SurfaceTable& table)
{
  const std::size_t n = std::size_t(count);
  place(position, rowFromA);
  normalX[n] = normal.x;
  normalY[n] = normal.y;
  normalZ[n] = normal.z;
  radiusMm[n] = radius;
  setReach(int(n), coarse, table);
}

void PointList::reserve(int more)
{
  const std::size_t room = std::size_t(count + inWholeVectors(more) + vectorWidth);
  if (x.size() < room)
  {
    resizeAll({ &x, &y, &z, &normalX, &normalY, &normalZ, &uX, &uY, &uZ, &vX, &vY, &vZ, &areaMm2, &phaseRe, &phaseIm },
              2 * room);
    resizeAll({ &row, &piece }, 2 * room);
  }
}

void PointList::push(const SurfacePoint& point, int ofPiece)
{
  reserve(1);
  const std::size_t n = std::size_t(count++);
  x[n] = point.position.x;
  y[n] = point.position.y;
  z[n] = point.position.z;
  normalX[n] = point.normal.x;
  normalY[n] = point.normal.y;
  normalZ[n] = point.normal.z;
  uX[n] = point.tangentU.x;
  uY[n] = point.tangentU.y;
  uZ[n] = point.tangentU.z;
  vX[n] = point.tangentV.x;
  vY[n] = point.tangentV.y;
  vZ[n] = point.tangentV.z;
  areaMm2[n] = point.areaMm2;
  phaseRe[n] = point.phaseRe;
  phaseIm[n] = point.phaseIm;
  row[n] = point.row;
  piece[n] = ofPiece;
}

void PointList::pad()
{
  reserve(0);
  for (int n = count; n < inWholeVectors(count); ++n)
  {
    const std::size_t at = std::size_t(n);
    const std::size_t last = std::size_t(count - 1);
    for (std::vector<float>* values : { &x, &y, &z, &normalX, &normalY, &normalZ, &uX, &uY, &uZ, &vX, &vY, &vZ })
    {
      (*values)[at] = (*values)[last];
    }
    areaMm2[at] = 0.0f;
    row[at] = row[last];
    piece[at] = piece[last];
  }
}

void addNet(const SurfacePiece& piece, const PieceNet& net, int row, int ofPiece, PointList& points)
{
  points.reserve(net.points());
  layOutNet(piece, net, row, ofPiece, points);
  points.count += net.points();
}

} // namespace sono
