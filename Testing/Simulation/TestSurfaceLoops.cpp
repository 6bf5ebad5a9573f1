#include "BeamScenes.h"
#include "Core/Simd.h"
#include "Echo/SurfaceLoops.h"
#include "Echo/SurfaceRows.h"
#include "SurfaceFigures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

// The loops over many faces, pieces and points against the kernels that take one at a time, as a GPU does.

namespace sono::test {
namespace {

constexpr int sampleCount = 4000;
constexpr int pieceCount = 203; // no whole number of vectors

class SurfaceLoops : public testing::TestWithParam<bool>
{
protected:
  SurfaceLoops()
    : settings(GetParam() ? echoOf(p42(), 120.0) : surfaceSettings())
    , model(settings, InterfaceModel::Acoustic)
    , rows({ { surfaceTissue("a", 1.5, 0.0), surfaceTissue("b", 3.0, 0.05), surfaceTissue("c", 1.7, 0.2) }, 3, -1 },
           settings, beamExtent(model), 0.2, 0.6)
    , table(rows.view(0.5))
    , grid(makeLineGrid(float(settings.sampleMm()), 4.0 * M_PI * settings.centreFrequencyMHz / 1.54, sampleCount))
  {
    beam = model.beamOf(makeScanLines(p42().geometry, ProbePose()).at(20), Vec3d(1.0, 2.0, 3.0), Mat3d(1.0));
    for (int b = 0; b < 200; ++b)
    {
      bins.push_back(b < 150 ? std::exp(-0.03f * float(b)) : 0.0f);
    }
    intensity = { bins.data(), int(bins.size()), 2.0f };
  }

  float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); }
  Vec3f direction() { return glm::normalize(Vec3f(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)) + 1e-3f); }
  /// Near the line, mostly across it, from either side.
  SurfacePoint point()
  {
    SurfacePoint p{};
    p.position = beam.origin + beam.axis * uniform(-3.0f, 110.0f) + beam.lateral * uniform(-6.0f, 6.0f) +
                 beam.elevation * uniform(-6.0f, 6.0f);
    const float side = uniform(0.0f, 1.0f) < 0.5f ? -1.0f : 1.0f;
    p.normal = glm::normalize(side * beam.axis + uniform(0.0f, 1.5f) * direction());
    p.tangentU = 0.4f * glm::normalize(glm::cross(p.normal, direction()));
    p.tangentV = 0.4f * glm::cross(p.normal, glm::normalize(p.tangentU));
    p.areaMm2 = uniform(0.05f, 0.3f);
    const int a = int(uniform(0.0f, 2.999f));
    p.row = rows.row(a, (a + 1) % 3);
    const float phase = uniform(0.0f, 6.28f);
    p.phaseRe = std::cos(phase);
    p.phaseIm = std::sin(phase);
    return p;
  }

  EchoSettings settings;
  BeamModel model;
  SurfaceRows rows;
  SurfaceTable table;
  LineGrid grid;
  Beam beam{};
  std::vector<float> bins;
  SurfaceIntensity intensity;
  std::mt19937 random{ 7 };
};

TEST_P(SurfaceLoops, AreTheSumOfSinglePoints)
{
  PieceList pieces;
  PointList list;
  std::vector<float> alone(2 * sampleCount, 0.0f);
  std::vector<float> together(2 * sampleCount, 0.0f);
  SurfaceSum sum{ alone.data() };
  int heardPieces = 0;
  std::vector<std::int32_t> mayHear;
  for (int n = 0; n < pieceCount; ++n)
  {
    SurfacePoint p = point();
    mayHear.push_back(n % 5 == 0 ? 0 : 1);
    const bool coarse = n % 2 == 0;
    pieces.push(p.position, p.normal, 0.7f, coarse, p.row, table);
    const SurfaceHearing heard = hearSurface(p.position, p.normal, 0.7f, coarse, p.row, beam, grid, table, intensity);
    heardPieces += heard.lit > 0.0f ? 1 : 0;
    for (int i = 0; i < 5; ++i)
    {
      p.position += 0.3f * direction();
      list.push(p, n);
      if (heard.diffuse && mayHear.back())
      {
        addDiffuse(p, beam, grid, table, heard, sum);
      }
      if (heard.coherent && mayHear.back())
      {
        addCoherent(p, beam, grid, table, heard, sum);
      }
    }
  }
  list.pad();
  EXPECT_GT(heardPieces, 20);
  HeardList heard;
  mayHear.resize(std::size_t(inWholeVectors(pieces.count)));
  hearPieces(pieces, mayHear.data(), beam, grid, table, intensity, heard);
  addDiffusePoints(list, heard, beam, grid, table, together.data());
  addCoherentPoints(list, heard, beam, grid, table, together.data());
  float peak = 0.0f;
  for (const float v : alone)
  {
    peak = std::max(peak, std::fabs(v));
  }
  EXPECT_GT(peak, 1e-4f);
  for (std::size_t s = 0; s < alone.size(); ++s)
  {
    // A place of thousands of samples is rounded to 2e-4 of one, with or without fused multiplications: so is the
    // phase.
    ASSERT_NEAR(together[s], alone[s], 1e-4f * peak) << s;
  }
}

TEST_P(SurfaceLoops, MarkTheFacesThatMayBeHeard)
{
  FaceList faces;
  std::vector<SurfacePoint> points;
  for (int n = 0; n < pieceCount; ++n)
  {
    points.push_back(point());
    points.back().normal *= n % 7 == 0 ? 0.0f : 1.0f; // not known
    faces.reserve(1);
    faces.push(points.back().position, points.back().normal, rows.at(points.back().row),
               rows.at(points.back().row ^ 1));
  }
  std::vector<std::int32_t> heard(std::size_t(inWholeVectors(pieceCount)), 0);
  markHeard(faces, 1.0f, beam, grid, heard.data());
  int count = 0;
  for (std::size_t n = 0; n < points.size(); ++n)
  {
    const bool may = mayHearSurface(points[n].position, points[n].normal, 1.0f, points[n].row, beam, grid, table);
    EXPECT_EQ(heard[n] != 0, may) << n;
    count += may;
  }
  EXPECT_GT(count, 20);
  EXPECT_LT(count, pieceCount - 20);
}

TEST_P(SurfaceLoops, LayOutEachPointOfANet)
{
  PointList list;
  std::vector<SurfacePoint> points;
  for (int axis = 0; axis < 3; ++axis)
  {
    SurfacePiece piece{};
    piece.positionMm = Vec3f(3.0f, -2.0f, 7.0f);
    piece.slopeU = 0.3f;
    piece.slopeV = -0.6f;
    piece.bendUU = 0.1f;
    piece.bendUV = 0.02f;
    piece.bendVV = -0.2f;
    piece.share = 0.8f;
    piece.axis = std::uint8_t(axis);
    const PieceNet net{ 3, 7, 0.2f, 0.15f };
    addNet(piece, net, 4, axis, list);
    for (int n = 0; n < net.points(); ++n)
    {
      points.push_back(piecePoint(piece, net, n));
    }
  }
  ASSERT_EQ(list.count, int(points.size()));
  for (std::size_t n = 0; n < points.size(); ++n)
  {
    const SurfacePoint& p = points[n];
    EXPECT_LT(glm::distance(Vec3f(list.x[n], list.y[n], list.z[n]), p.position), 2e-6f);
    EXPECT_LT(glm::distance(Vec3f(list.normalX[n], list.normalY[n], list.normalZ[n]), p.normal), 1e-6f);
    EXPECT_LT(glm::distance(Vec3f(list.uX[n], list.uY[n], list.uZ[n]), p.tangentU), 1e-6f);
    EXPECT_LT(glm::distance(Vec3f(list.vX[n], list.vY[n], list.vZ[n]), p.tangentV), 1e-6f);
    EXPECT_NEAR(list.areaMm2[n], p.areaMm2, 1e-7f);
    EXPECT_EQ(list.piece[n], int(n) / 21);
  }
}

INSTANTIATE_TEST_SUITE_P(OfAnAperture, SurfaceLoops, testing::Bool());

} // namespace
} // namespace sono::test
