#include "EchoScenes.h"
#include "TestScenes.h"

#include "Scene/FibreField.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace sono;
using namespace sono::test;

constexpr double insideMm = 15.0;
constexpr double outsideMm = 25.0;
constexpr double lengthMm = 80.0;

Tissue muscle(double anisotropyDb)
{
  Tissue t = makeTissue("myocardium", 1.6, 1540.0, 0.0);
  t.backscatterPerCmSr = 1e-4;
  t.scattererSigma = 0.3;
  t.scattererProbability = 0.7;
  t.fibreAnisotropyDb = anisotropyDb;
  return t;
}

/// A tube of muscle along z around blood, capped by nothing: local centre (30, 30).
std::unique_ptr<Scene> tube(double spacingMm)
{
  const Vec3i size(glm::round(Vec3d(60.0, 60.0, lengthMm) / spacingMm));
  return makeScene(size, Vec3d(spacingMm),
                   { muscle(14.5), makeTissue("blood", 1.6, 1540.0, 0.0), makeTissue("fat", 1.6, 1540.0, 0.0) },
                   [](const Vec3d& p) {
                     const double radius = std::hypot(p.x - 30.0, p.y - 30.0);
                     return radius < insideMm ? 1 : (radius < outsideMm ? 0 : 2);
                   });
}

TEST(FibreField, TurnsFromTheCavityToTheOutside)
{
  const double spacingMm = 1.0;
  const auto scene = tube(spacingMm);
  const FibreField* fibres = scene->fibres();
  ASSERT_NE(fibres, nullptr);
  double worstDeg = 0.0;
  for (int n = 0; n < 360; n += 7)
  {
    for (double radius = insideMm + 1.0; radius < outsideMm - 1.0; radius += 0.9)
    {
      const double around = n * M_PI / 180.0;
      const Vec3d p(30.0 + radius * std::cos(around), 30.0 + radius * std::sin(around), 40.0);
      const Vec3i voxel(glm::floor(p / spacingMm));
      const Vec3d centre = (Vec3d(voxel) + 0.5) * spacingMm;
      const double r = std::hypot(centre.x - 30.0, centre.y - 30.0);
      // A right-handed helix inside: it climbs along +z as it turns about +z.
      const double angle = (60.0 - 120.0 * (r - insideMm) / (outsideMm - insideMm)) * M_PI / 180.0;
      const Vec3d tangent(-(centre.y - 30.0) / r, (centre.x - 30.0) / r, 0.0);
      const Vec3d expected = std::cos(angle) * tangent + Vec3d(0.0, 0.0, std::sin(angle));
      const Vec3d got(fibres->at(voxel));
      EXPECT_NEAR(glm::length(got), 1.0, 0.01);
      const double cosine = std::min(1.0, std::abs(glm::dot(glm::normalize(got), expected)));
      worstDeg = std::max(worstDeg, std::acos(cosine) * 180.0 / M_PI);
    }
  }
  EXPECT_LT(worstDeg, 10.0); // half a voxel of the wall's 10 mm is 6 degrees
}

TEST(FibreField, ASeptumTurnsFromTheLeftVentricleToTheRight)
{
  // Two slabs of blood; the left ventricle's has the name. Around is across its long axis, z.
  LabelVolume volume;
  volume.placement.size = { 60, 40, 90 };
  volume.voxels.resize(volume.placement.voxelCount());
  std::size_t at = 0;
  for (int k = 0; k < 90; ++k)
  {
    for (int j = 0; j < 40; ++j)
    {
      for (int i = 0; i < 60; ++i)
      {
        volume.voxels[at++] = std::uint16_t(i < 20 ? 1 : (i < 30 ? 2 : 3));
      }
    }
  }
  volume.collectLabels();
  volume.labels[0].name = "left_ventricle_blood";
  std::vector<std::uint8_t> tissues(volume.voxels.begin(), volume.voxels.end());
  for (std::uint8_t& t : tissues)
  {
    t = t == 2 ? 0 : 1;
  }
  const FibreField field = buildFibreField(volume, tissues, { true, false }, { false, true });
  const auto angleDeg = [&](int i) {
    const Vec3f f = field.at({ i, 20, 45 });
    return std::atan2(double(f.z), double(f.y)) * 180.0 / M_PI; // outwards is x, around is y
  };
  const auto turned = [](double deg) { return deg > 90.0 ? deg - 180.0 : (deg < -90.0 ? deg + 180.0 : deg); };
  for (int i = 21; i < 29; ++i)
  {
    EXPECT_NEAR(turned(angleDeg(i)), 60.0 - 120.0 * (i + 0.5 - 20.0) / 10.0, 1.5) << i;
  }
  EXPECT_EQ(field.at({ 10, 20, 45 }), Vec3f(0.0f));
}

TEST(FibreField, OfAPapillaryMuscleRunAlongIt)
{
  // A rod through blood, slanting, and the wall that it stands on.
  LabelVolume volume;
  volume.placement.size = { 40, 40, 60 };
  volume.voxels.assign(volume.placement.voxelCount(), 1);
  const Vec3d from(14.0, 20.0, 10.0);
  const Vec3d along = glm::normalize(Vec3d(0.3, 0.1, 1.0));
  const auto at = [&](int i, int j, int k) -> std::uint16_t& {
    return volume.voxels[std::size_t(i + 40 * (j + 40 * k))];
  };
  for (int k = 0; k < 60; ++k)
  {
    for (int j = 0; j < 40; ++j)
    {
      for (int i = 0; i < 40; ++i)
      {
        const Vec3d way = Vec3d(i, j, k) + 0.5 - from;
        const double t = glm::dot(way, along);
        const bool isRod = t > 0.0 && t < 35.0 && glm::length(way - t * along) < 4.0;
        at(i, j, k) = isRod ? 3 : (i < 5 ? 2 : 1);
      }
    }
  }
  volume.collectLabels();
  volume.labels[0].name = "left_ventricle_blood";
  volume.labels[2].name = "Papillary_muscle";
  std::vector<std::uint8_t> tissues;
  for (const std::uint16_t label : volume.voxels)
  {
    tissues.push_back(label == 1 ? 1 : 0);
  }
  const FibreField field = buildFibreField(volume, tissues, { true, false }, { false, true });
  for (const double t : { 3.0, 15.0, 30.0 })
  {
    const Vec3d got = glm::normalize(Vec3d(field.at(Vec3i(glm::floor(from + t * along)))));
    EXPECT_GT(std::abs(glm::dot(got, along)), std::cos(2.0 * M_PI / 180.0)) << t;
  }
  EXPECT_LT(std::abs(field.at({ 2, 20, 30 }).x), 0.1f); // the wall's stay in it
}

TEST(FibreField, NoneWhereNoTissueHasAnisotropy)
{
  const auto scene = makeScene(Vec3i(10), Vec3d(1.0), { muscle(0.0) }, [](const Vec3d&) { return 0; });
  EXPECT_EQ(scene->fibres(), nullptr);
}

double powerDb(const RfLines& rf, double fromMm, double toMm)
{
  double power = 0.0;
  double count = 0.0;
  for (int line = 0; line < rf.lineCount; ++line)
  {
    for (int i = int(fromMm / rf.sampleMm); i < int(toMm / rf.sampleMm); ++i)
    {
      power += std::norm(rf.iq[std::size_t(line) * std::size_t(rf.sampleCount) + std::size_t(i)]);
      count += 1.0;
    }
  }
  return 10.0 * std::log10(power / count);
}

TEST(FibreField, MuscleEchoesLessAlongItsFibresThanAcross)
{
  // A thick wall across x; in its middle the fibres run around the long axis of the blood, z, along y.
  const auto make = [](double anisotropyDb) {
    return makeScene(
      Vec3i(100, 100, 120), Vec3d(1.0),
      { muscle(anisotropyDb), makeTissue("blood", 1.6, 1540.0, 0.0), makeTissue("fat", 1.6, 1540.0, 0.0) },
      [](const Vec3d& p) { return p.x < 20.0 ? 1 : (p.x > 80.0 ? 2 : 0); });
  };
  const auto scene = make(14.5);
  const auto isotropic = make(1e-9);
  EchoSettings s;
  s.lateralSigmaMm = 0.5;
  s.elevationalSigmaMm = 0.5;
  s.depthMm = 24.0;
  // The fibre where the beam passes, from the field itself: its angle is tested above.
  const Vec3i place(50, 50, 60);
  const Vec3d fibre(scene->fibres()->at(place));
  const Vec3d across = glm::normalize(glm::cross(fibre, Vec3d(1.0, 0.0, 0.0)));
  for (const double angleDeg : { 0.0, 30.0, 60.0, 90.0 })
  {
    const double t = angleDeg * M_PI / 180.0;
    const Vec3d axis = std::cos(t) * fibre + std::sin(t) * across; // stays at one depth of the wall
    std::vector<ScanLine> lines;
    for (int i = 0; i < 60; ++i)
    {
      const Vec3d side = glm::cross(axis, Vec3d(1.0, 0.0, 0.0));
      lines.push_back(makeLine((Vec3d(place) + 0.5) - 12.0 * axis + (0.6 * (i - 30)) * side, axis));
    }
    const double got = powerDb(formRf({ scene.get(), nullptr, nullptr }, lines, s), 4.0, 20.0);
    const double without = powerDb(formRf({ isotropic.get(), nullptr, nullptr }, lines, s), 4.0, 20.0);
    EXPECT_NEAR(got - without, -14.5 * std::cos(t) * std::cos(t), 0.8) << angleDeg;
  }
}

} // namespace
