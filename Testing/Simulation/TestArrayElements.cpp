#include "Folders.h"
#include "Probe/ArrayElements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sono {
namespace {

constexpr double pi = 3.14159265358979323846;

ProbePreset bundled(const std::string& name)
{
  return readProbePreset(dataFile("probes/" + name + ".json"));
}

int activeCount(const ArrayElements& elements, const ProbeSettings& probe, int line)
{
  const LineFiring firing = lineFiring(elements, probe, makeScanLines(probe.geometry, ProbePose())[std::size_t(line)]);
  return int(std::count(firing.isActive.begin(), firing.isActive.end(), true));
}

/// As Verasonics publishes the P4-2: 64 elements of 0.295 mm, 0.320 mm apart. All send each line.
TEST(ArrayElements, OfThePhasedArrayAreItsOwn)
{
  const ProbePreset probe = bundled("phased_p4-2");
  const ArrayElements elements = arrayElements(probe);
  ASSERT_EQ(elements.centresMm.size(), 64u);
  EXPECT_EQ(elements.widthMm, 0.295);
  EXPECT_EQ(elements.heightMm, 14.0);
  for (std::size_t n = 0; n < 64; ++n)
  {
    EXPECT_NEAR(elements.centresMm[n].x, 0.32 * (double(n) - 31.5), 1e-12);
    EXPECT_EQ(elements.centresMm[n].z, 0.0);
  }
  EXPECT_EQ(activeCount(elements, probe, 0), 64);
  ProbeSettings half = probe;
  half.apertureMm = 10.0; // 31 pitches and an element
  EXPECT_EQ(arrayElements(half).centresMm.size(), 64u);
  EXPECT_EQ(activeCount(elements, half, 0), 32);
  half.apertureMm = 40.0; // more than the array has
  EXPECT_EQ(arrayElements(half).centresMm.size(), 125u);
}

/// 128 elements, a line at each; those that make F/2 send it, at the ends half of them.
TEST(ArrayElements, OfTheLinearArrayLieUnderTheLines)
{
  const ProbePreset probe = bundled("linear_l14");
  const ArrayElements elements = arrayElements(probe);
  const std::vector<ScanLine> lines = makeScanLines(probe.geometry, ProbePose());
  ASSERT_EQ(elements.centresMm.size(), 128u);
  for (std::size_t n = 0; n < 128; ++n)
  {
    EXPECT_NEAR(glm::length(elements.centresMm[n] - lines[n].originMm), 0.0, 1e-6);
  }
  EXPECT_EQ(activeCount(elements, probe, 64), 33); // 20 mm / 2 / 0.3048 mm
  EXPECT_EQ(activeCount(elements, probe, 0), 17);
  ProbeSettings narrow = probe;
  narrow.geometry.widthMm = 20.0;
  EXPECT_EQ(arrayElements(narrow).centresMm.size(), 128u); // the array stays as it was built
  narrow.elementCount = 0;
  EXPECT_EQ(arrayElements(narrow).centresMm.size(), 67u); // 20 mm / 0.3048 mm and one
}

TEST(ArrayElements, OfTheCurvedArrayLieOnItsFace)
{
  const ProbePreset probe = bundled("curvilinear_c5-2");
  const ArrayElements elements = arrayElements(probe);
  ASSERT_EQ(elements.centresMm.size(), 128u);
  const Vec3d centre(0.0, 0.0, -49.57);
  for (std::size_t n = 0; n < 128; ++n)
  {
    EXPECT_NEAR(glm::length(elements.centresMm[n] - centre), 49.57, 1e-9);
    EXPECT_NEAR(elements.azimuthsRad[n], 0.508 / 49.57 * (double(n) - 63.5), 1e-9);
  }
}

/// There is room for so many around a catheter, whatever the preset of another probe says.
TEST(ArrayElements, GoAroundACatheterOnce)
{
  ProbeSettings probe;
  probe.geometry.kind = ScanKind::Radial;
  probe.geometry.sectorDeg = 360.0;
  probe.geometry.radiusMm = 0.6;
  const ArrayElements elements = arrayElements(probe);
  EXPECT_EQ(elements.centresMm.size(), std::size_t(2.0 * pi * 0.6 / 0.32));
}

TEST(ArrayElements, OfAMatrixAreRows)
{
  ProbeSettings probe;
  probe.geometry.kind = ScanKind::Matrix;
  probe.elementCount = 32 * 32;
  probe.elementWidthMm = 0.3;
  probe.kerfMm = 0.02;
  probe.apertureMm = 31 * 0.32 + 0.3;
  probe.elevationApertureMm = probe.apertureMm;
  const ArrayElements elements = arrayElements(probe);
  ASSERT_EQ(elements.centresMm.size(), 1024u);
  EXPECT_NEAR(elements.centresMm[33].x - elements.centresMm[0].x, 0.32, 1e-12);
  EXPECT_NEAR(elements.centresMm[33].y - elements.centresMm[0].y, 0.32, 1e-12);
  EXPECT_EQ(elements.heightMm, 0.3);
  EXPECT_EQ(activeCount(elements, probe, 0), 1024);
}

} // namespace
} // namespace sono
