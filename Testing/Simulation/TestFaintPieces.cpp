#include "BeamScenes.h"
#include "Echo/FaintPieces.h"
#include "Echo/LayOutPieces.h"
#include "Echo/SurfaceRows.h"
#include "Scene/SurfacePieces.h"
#include "SurfaceFigures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

// Pieces that are left out as a whole against the echoes of each of their points.

namespace sono::test {
namespace {

/// Whether anything was added.
struct AnySum
{
  bool any = false;

  void add(int, float re, float im) { any = any || re != 0.0f || im != 0.0f; }
};

class FaintPieces : public testing::TestWithParam<std::string>
{
};

TEST_P(FaintPieces, AreThoseWithoutAnyPointThatIsHeard)
{
  ProbePreset preset = p42();
  EchoSettings settings = surfaceSettings();
  settings.depthMm = 120.0;
  if (!GetParam().empty())
  {
    preset = readProbePreset(dataFile("probes/" + GetParam()));
    settings = echoOf(preset, preset.geometry.depthMm);
  }
  const BeamModel model(settings, InterfaceModel::Acoustic);
  const float spacing = 1.0f;
  const SurfaceRows rows(
    { { surfaceTissue("a", 1.5, 0.0), surfaceTissue("b", 3.0, 0.05), surfaceTissue("c", 1.53, 0.2) }, 3, -1 }, settings,
    beamExtent(model), 0.2, 0.6);
  const SurfaceTable table = rows.view(0.5);
  const int sampleCount = settings.sampleCount();
  const LineGrid grid = makeLineGrid(float(settings.sampleMm()),
                                     4.0 * M_PI * settings.centreFrequencyMHz / assumedSoundSpeedMmPerUs, sampleCount);
  std::vector<float> bins;
  for (int b = 0; b < 2 * int(settings.depthMm); ++b)
  {
    bins.push_back(std::exp(-0.05f * float(b)));
  }
  const SurfaceIntensity intensity{ bins.data(), int(bins.size()), 2.0f };
  std::mt19937 random(11);
  const auto uniform = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
  const auto lines = makeScanLines(preset.geometry, ProbePose());
  int heardPieces = 0;
  int silentPieces = 0;
  int leftOut = 0;
  for (const int line : { 3, int(lines.size()) / 2 })
  {
    const Beam beam = model.beamOf(lines[std::size_t(line)], Vec3d(1.0, 2.0, 3.0), Mat3d(1.0));
    PieceList pieces;
    PieceShapes shapes;
    PieceExtents extents;
    std::vector<SurfacePiece> all;
    // Two points along each side of a piece, and four of one that is bent.
    const PieceNets nets{ { Vec3i(2) }, Vec3f(spacing), Vec3i(2), Vec3i(4), 1e6f };
    const PieceNet diffuse{ 2, 2, spacing / 2.0f, spacing / 2.0f };
    for (int n = 0; n < 6001; ++n)
    {
      SurfacePiece piece{};
      piece.positionMm = beam.origin + beam.axis * uniform(-2.0f, float(settings.depthMm)) +
                         beam.lateral * uniform(-4.0f, 4.0f) + beam.elevation * uniform(-4.0f, 4.0f);
      piece.slopeU = uniform(-1.0f, 1.0f) * uniform(0.0f, 1.0f);
      piece.slopeV = uniform(-1.0f, 1.0f) * uniform(0.0f, 1.0f);
      piece.bendUU = n % 3 == 0 ? 0.0f : uniform(-0.3f, 0.3f);
      piece.bendUV = n % 3 == 0 ? 0.0f : uniform(-0.1f, 0.1f);
      piece.bendVV = n % 3 == 0 ? 0.0f : uniform(-0.3f, 0.3f);
      piece.share = uniform(0.2f, 1.0f);
      piece.axis = std::uint8_t(n % 5 == 0 ? n % 2 : 2);
      const int a = n % 3;
      pieces.place(piece.positionMm, rows.row(a, (a + 1) % 3));
      shapes.push(piece);
      all.push_back(piece);
    }
    layOutPieces(shapes, nets, spacing, table, pieces, extents);
    const auto coherentNet = [&](std::size_t n) {
      const int cuts = n % 3 == 0 ? 2 : 4;
      return PieceNet{ cuts, cuts, spacing / float(cuts), spacing / float(cuts) };
    };
    for (std::size_t n = 0; n < all.size(); ++n)
    {
      const PieceBounds bounds = pieceBounds(all[n], spacing);
      ASSERT_NEAR(glm::distance(bounds.normal, Vec3f(pieces.normalX[n], pieces.normalY[n], pieces.normalZ[n])), 0.0f,
                  1e-6f);
      ASSERT_NEAR(pieces.radiusMm[n], bounds.radiusMm, 1e-6f);
      const SurfaceRow& row = table.rows[pieces.row[n]];
      ASSERT_EQ(pieces.coherentReachA[n], n % 3 == 0 ? row.coherentReach : row.finestReach);
    }
    HeardList heard;
    hearPieces(pieces, nullptr, beam, grid, table, intensity, heard);
    const HeardList before = heard;
    leaveFaint(pieces, extents, beam, grid, table, rows.diffuseMost().data(), heard);
    for (std::size_t n = 0; n < all.size(); ++n)
    {
      const auto isHeard = [&](const PieceNet& net, float lit, bool coherent) {
        const SurfaceHearing hearing{ lit, before.most[n], !coherent, coherent };
        AnySum sum;
        for (int p = 0; p < net.points(); ++p)
        {
          SurfacePoint point = piecePoint(all[n], net, p);
          point.row = pieces.row[n];
          point.phaseRe = 1.0f;
          coherent ? addCoherent(point, beam, grid, table, hearing, sum)
                   : addDiffuse(point, beam, grid, table, hearing, sum);
        }
        return sum.any;
      };
      for (const bool coherent : { false, true })
      {
        const float was = coherent ? before.coherent[n] : before.diffuse[n];
        const float is = coherent ? heard.coherent[n] : heard.diffuse[n];
        if (!(was > 0.0f))
        {
          EXPECT_EQ(is, 0.0f);
        }
        else if (isHeard(coherent ? coherentNet(n) : diffuse, was, coherent))
        {
          EXPECT_EQ(is, was) << (coherent ? "coherent " : "diffuse ") << n;
          ++heardPieces;
        }
        else
        {
          ++silentPieces;
          leftOut += is == 0.0f ? 1 : 0;
        }
      }
    }
    EXPECT_TRUE(heard.anyDiffuse);
    EXPECT_TRUE(heard.anyCoherent);
  }
  EXPECT_GT(heardPieces, 300);
  EXPECT_GT(leftOut, silentPieces / 3) << silentPieces;
}

INSTANTIATE_TEST_SUITE_P(OfProbes, FaintPieces,
                         testing::Values("", "phased_p4-2.json", "curvilinear_c5-2.json", "linear_l14.json"));

TEST(SurfacePieces, AreFittedAheadAsWhenTheyAreAskedFor)
{
  // A ball of one tissue in another.
  const Vec3i size(40);
  std::vector<std::uint8_t> tissues;
  for (int n = 0; n < size.x * size.y * size.z; ++n)
  {
    const Vec3d at = Vec3d(n % size.x, n / size.x % size.y, n / size.x / size.y) - 19.3;
    tissues.push_back(glm::length(at) < 12.0 ? 1 : 0);
  }
  const SurfacePieces ahead(tissues.data(), size, Vec3d(1.0));
  const SurfacePieces asked(tissues.data(), size, Vec3d(1.0));
  int told = 0;
  ahead.fitCoarse({ Vec3i(0), size }, [&](double fraction) {
    EXPECT_GE(fraction, 0.0);
    EXPECT_LT(fraction, 1.0);
    return ++told < 100000;
  });
  EXPECT_GT(told, 200); // a face each
  int stopped = 0;
  ahead.fitCoarse({ Vec3i(0), size }, [&](double) { return ++stopped < 20; });
  EXPECT_EQ(stopped, 20);
  for (int b = 0; b < ahead.bricks().x * ahead.bricks().y * ahead.bricks().z; ++b)
  {
    const Vec3i brick(b % ahead.bricks().x, b / ahead.bricks().x % ahead.bricks().y,
                      b / ahead.bricks().x / ahead.bricks().y);
    for (std::size_t face = 0; face < ahead.coarseCount(brick); ++face)
    {
      --told;
      const SurfacePiece* one = ahead.piece(brick, face);
      const SurfacePiece* other = asked.piece(brick, face);
      ASSERT_EQ(one != nullptr, other != nullptr);
      if (one)
      {
        EXPECT_EQ(one->positionMm, other->positionMm);
        EXPECT_EQ(one->slopeU, other->slopeU);
        EXPECT_EQ(one->bendVV, other->bendVV);
      }
    }
  }
  EXPECT_EQ(told, 0);
}

} // namespace
} // namespace sono::test
