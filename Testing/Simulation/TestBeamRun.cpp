#include "BeamScenes.h"
#include "Echo/SurfaceRows.h"
#include "Kernel/BeamRun.h"
#include "SurfaceFigures.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

// What is ruled out for neighbouring lines at once, against each of the lines.

namespace sono::test {
namespace {

constexpr int runLines = 16;
constexpr int sampleCount = 4000;
constexpr int faceCount = 10000;

class BeamRuns : public testing::TestWithParam<BeamKind>
{
protected:
  BeamRuns()
    : settings(settingsOf(GetParam()))
    , model(settings, InterfaceModel::Acoustic)
    , rows({ { surfaceTissue("a", 1.5, 0.0), surfaceTissue("b", 3.0, 0.05), surfaceTissue("c", 1.7, 0.2) }, 3, -1 },
           settings, beamExtent(model), 0.2, 0.6)
    , table(rows.view(0.5))
    , grid(makeLineGrid(float(settings.sampleMm()), 4.0 * M_PI * settings.centreFrequencyMHz / 1.54, sampleCount))
  {
    for (const ScanLine& line : makeScanLines(p42().geometry, ProbePose()))
    {
      beams.push_back(model.beamOf(line, line.originMm, Mat3d(1.0)));
    }
  }

  static EchoSettings settingsOf(BeamKind kind)
  {
    EchoSettings s = kind == BeamKind::Gaussian ? surfaceSettings() : echoOf(p42(), 120.0);
    s.depthMm = 120.0;
    s.arrayField = kind == BeamKind::Array ? std::make_shared<ArrayField>(apertureOf(p42()), s.depthMm) : nullptr;
    return s;
  }

  float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); }

  EchoSettings settings;
  BeamModel model;
  SurfaceRows rows;
  SurfaceTable table;
  LineGrid grid;
  std::vector<Beam> beams;
  std::mt19937 random{ 11 };
};

TEST_P(BeamRuns, RuleOutNoFaceThatALineMayHear)
{
  ASSERT_EQ(beams.front().kind, GetParam());
  int heard = 0;
  int unheard = 0;
  int ruledOut = 0;
  for (int n = 0; n < faceCount; ++n)
  {
    const Vec3f position(uniform(-90.0f, 90.0f), uniform(-15.0f, 15.0f), uniform(-5.0f, 130.0f));
    const Vec3f normal = glm::normalize(Vec3f(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)) + 1e-3f);
    const Vec3f known = n % 7 == 0 ? Vec3f(0.0f) : normal;
    const int a = int(uniform(0.0f, 2.999f));
    const int row = rows.row(a, (a + 1) % 3);
    for (int first = 0; first < int(beams.size()); first += runLines)
    {
      const int count = std::min(runLines, int(beams.size()) - first);
      const BeamRun run = beamRun(beams.data(), first, count);
      bool any = false;
      for (int line = first; line < first + count; ++line)
      {
        any = any || mayHearSurface(position, known, 1.0f, row, beams[std::size_t(line)], grid, table);
      }
      const bool some = someMayHearSurface(position, known, 1.0f, row, run, grid, table);
      ASSERT_TRUE(some || !any) << "face " << n << ", lines from " << first;
      heard += any;
      unheard += !any;
      ruledOut += !some;
    }
  }
  EXPECT_GT(heard, 200);
  EXPECT_GT(ruledOut, 9 * unheard / 10);
}

INSTANTIATE_TEST_SUITE_P(OfAnyKind, BeamRuns, testing::Values(BeamKind::Gaussian, BeamKind::Aperture, BeamKind::Array));

} // namespace
} // namespace sono::test
