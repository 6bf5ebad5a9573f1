#include "ErrorText.h"
#include "LayeredScene.h"

#include "Image/LabelSlice.h"
#include "Simulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

// What a scanner shows that takes another speed of sound than the tissue has: Data/docs/physics.md 13.1.

using namespace sono;
using namespace sono::test;
using sono::testing::errorOf;
using sono::testing::expectContains;

namespace {

/// 50 mm of a tissue before another of twice its impedance.
std::unique_ptr<Scene> wallBehind(double speed)
{
  return layeredScene({ { 50.0, 1.6, speed, 0.1 }, { 75.0, 3.2, speed, 0.1 } });
}

ImageInput inputOf(ScanKind kind, double assumedMPerS)
{
  ImageInput input;
  input.pose.positionMm = { 10.0, 10.0, 0.0 };
  ImageSettings& s = input.settings;
  s.geometry.kind = kind;
  s.geometry.lineCount = 17;
  s.geometry.elevationLineCount = 5;
  s.geometry.elevationSectorDeg = 4.0;
  s.geometry.widthMm = 8.0;
  s.geometry.sectorDeg = 8.0;
  s.geometry.depthMm = 60.0;
  s.geometry.assumedSoundSpeedMPerS = assumedMPerS;
  s.tracing.pathsPerLine = 16;
  s.bmode.tgcDbPerCm = 0.0;
  s.bmode.dynamicRangeDb = 120.0;
  s.pixelMm = kind == ScanKind::Matrix ? 0.25 : 0.05;
  s.matchStages();
  s.setDevice(Device::Cpu);
  return input;
}

/// A column of an image from the face down, where it is on the axis.
struct Column
{
  double firstMm;
  double stepMm;
  std::vector<float> grey;
  std::vector<std::uint16_t> labels;

  double brightestMm() const
  {
    const auto first = std::size_t((20.0 - firstMm) / stepMm); // past what is near the face
    return firstMm + stepMm * double(std::max_element(grey.begin() + std::ptrdiff_t(first), grey.end()) - grey.begin());
  }
  /// Where the label of the tissue behind begins.
  double wallMm() const
  {
    return firstMm + stepMm * (double(std::find(labels.begin(), labels.end(), 1) - labels.begin()) - 0.5);
  }
};

Column columnOf(const Scene& scene, const ImageInput& input)
{
  Simulator simulator(std::shared_ptr<const Scene>(std::shared_ptr<void>(), &scene));
  const ImageResult image = simulator.image(input);
  const ScanPicture picture = simulator.picture(image, input.settings.geometry, input.pose, simulator.traced(input));
  const auto columnAt = [&](const std::vector<float>& value, std::size_t first, std::size_t step, double firstMm) {
    Column column{ firstMm, input.settings.pixelMm, {}, {} };
    for (std::size_t i = first; i < value.size(); i += step)
    {
      column.grey.push_back(value[i]);
      column.labels.push_back(picture.labels[i]);
    }
    return column;
  };
  if (image.isVolume())
  {
    const VolumeImage& volume = image.volume();
    const auto plane = std::size_t(volume.size.x) * std::size_t(volume.size.y);
    return columnAt(volume.value, std::size_t(volume.size.y / 2 * volume.size.x + volume.size.x / 2), plane,
                    volume.minMm.z);
  }
  const PlaneImage& plane = image.plane().host();
  return columnAt(plane.value, std::size_t(plane.width / 2), std::size_t(plane.width), plane.axialMinMm);
}

/// Brightest place of a picture of points at 1540 m/s, beside the axis by at least so much.
Vec2d brightestBeside(const std::vector<PointScatterer>& points, ImageSettings settings, double sign)
{
  settings.echo.aperture = { 5.0, 5.0, 40.0, 40.0, 0.0, false };
  settings.matchStages();
  Simulator simulator;
  const auto rf = simulator.formRf(makeScanLines(settings.geometry, ProbePose()), TracedResult(), settings.echo,
                                   std::make_shared<const PointScatterers>(points));
  const PlaneImage image =
    simulator.scanConvert(settings.geometry, simulator.makeBMode(rf, settings.bmode), settings.pixelMm).plane().host();
  Vec2d place(0.0);
  float best = 0.0f;
  for (std::size_t p = 0; p < image.value.size(); ++p)
  {
    const double lateral = image.lateralMinMm + double(p % std::size_t(image.width)) * image.pixelMm;
    if (sign * lateral > 0.5 && image.value[p] > best)
    {
      best = image.value[p];
      place = { lateral, image.axialMinMm + double(p / std::size_t(image.width)) * image.pixelMm };
    }
  }
  return place;
}

} // namespace

TEST(AssumedSoundSpeed, AWallIsShownWhereItsTimeTimesTheAssumedSpeedSays)
{
  for (const double speed : { 1450.0, 1540.0, 1620.0 })
  {
    const auto scene = wallBehind(speed);
    for (const double assumed : { 1400.0, 1480.0, 1540.0, 1700.0 })
    {
      for (const ScanKind kind : { ScanKind::Linear, ScanKind::Curvilinear })
      {
        const Column column = columnOf(*scene, inputOf(kind, assumed));
        const double shownMm = 50.0 * assumed / speed;
        EXPECT_NEAR(column.brightestMm(), shownMm, 0.08) << speed << " " << assumed << " " << int(kind);
        EXPECT_NEAR(column.wallMm(), shownMm, 0.08) << speed << " " << assumed << " " << int(kind);
      }
    }
  }
}

TEST(AssumedSoundSpeed, LabelsFollowThePictureOfEveryKind)
{
  const auto scene = wallBehind(1600.0);
  for (const ScanKind kind : { ScanKind::PhasedSector, ScanKind::Radial, ScanKind::Matrix })
  {
    ImageInput input = inputOf(kind, 1450.0);
    input.settings.geometry.radiusMm = 2.0;
    const double facesMm = kind == ScanKind::Radial ? 2.0 : 0.0; // from the pose's position
    const double shownMm = facesMm + (50.0 - facesMm) * 1450.0 / 1600.0;
    const double withinMm = kind == ScanKind::Matrix ? 0.3 : 0.08;
    const Column column = columnOf(*scene, input);
    EXPECT_NEAR(column.brightestMm(), shownMm, withinMm) << int(kind);
    EXPECT_NEAR(column.wallMm(), shownMm, withinMm) << int(kind);
  }
  ImageInput compounded = inputOf(ScanKind::Linear, 1450.0);
  compounded.settings.geometry.compoundFans = 3;
  compounded.settings.geometry.compoundSpanDeg = 10.0;
  EXPECT_NEAR(columnOf(*scene, compounded).wallMm(), 50.0 * 1450.0 / 1600.0, 0.08);
}

TEST(AssumedSoundSpeed, TheHarmonicIsShownAlike)
{
  ImageInput input = inputOf(ScanKind::Linear, 1450.0);
  input.settings.echo.imagingMode = ImagingMode::Harmonic;
  input.settings.echo.aperture = { 8.0, 8.0, 50.0, 50.0, 0.0, false };
  input.settings.matchStages();
  const auto scene = layeredScene({ { 50.0, 1.6, 1600.0, 0.1 }, { 75.0, 3.2, 1600.0, 0.1 } },
                                  [](Tissue& tissue) { tissue.nonlinearity = 4.0; });
  EXPECT_NEAR(columnOf(*scene, input).brightestMm(), 50.0 * 1450.0 / 1600.0, 0.08);
}

/// Its ranges are depths, as of a body of 1540 m/s.
TEST(AssumedSoundSpeed, AmadousBodyHasThatOfTheDefault)
{
  ImageInput input = inputOf(ScanKind::Linear, 1450.0);
  input.settings.tracing.model = InterfaceModel::Amadou2024;
  const auto scene = wallBehind(1620.0);
  const Column column = columnOf(*scene, input);
  EXPECT_NEAR(column.brightestMm(), 50.0 * 1450.0 / 1540.0, 0.08);
  EXPECT_NEAR(column.wallMm(), 50.0 * 1450.0 / 1540.0, 0.08);
}

/// A picture's end is where its depth says, and nothing is missing before.
TEST(AssumedSoundSpeed, ThePictureReachesItsDepth)
{
  for (const double assumed : { 1400.0, 1700.0 })
  {
    const double wallMm = 59.0 * 1540.0 / assumed;
    const auto scene = layeredScene({ { wallMm, 1.6, 1540.0, 0.1 }, { 90.0, 3.2, 1540.0, 0.1 } });
    const Column column = columnOf(*scene, inputOf(ScanKind::Linear, assumed));
    EXPECT_NEAR(column.firstMm + column.stepMm * double(column.grey.size() - 1), 60.0, 0.06);
    EXPECT_NEAR(column.brightestMm(), 59.0, 0.35); // the wall is at a voxel's edge
    EXPECT_GT(column.grey[column.grey.size() - 10], 0.0f);
    EXPECT_EQ(column.labels.back(), 1);
  }
}

/// Along the lines distances are stretched; across them, in mm on a flat face and in degrees in a sector, they are not.
TEST(AssumedSoundSpeed, StretchesAlongTheLinesAlone)
{
  ImageSettings s = inputOf(ScanKind::Linear, 1480.0).settings;
  s.geometry.lineCount = 161;
  s.geometry.widthMm = 16.0;
  const Vec2d left = brightestBeside({ { { -4.0, 0.0, 35.0 }, 1.0f }, { { 5.0, 0.0, 45.0 }, 1.0f } }, s, -1.0);
  const Vec2d right = brightestBeside({ { { -4.0, 0.0, 35.0 }, 1.0f }, { { 5.0, 0.0, 45.0 }, 1.0f } }, s, 1.0);
  EXPECT_NEAR(right.x - left.x, 9.0, 0.11);
  EXPECT_NEAR(right.y - left.y, 10.0 * 1480.0 / 1540.0, 0.06);
  s.geometry.kind = ScanKind::PhasedSector;
  s.geometry.sectorDeg = 24.0;
  const double angle = 0.1;
  const Vec2d apart = brightestBeside({ { { 40.0 * std::sin(angle), 0.0, 40.0 * std::cos(angle) }, 1.0f } }, s, 1.0);
  EXPECT_NEAR(std::atan2(apart.x, apart.y), angle, 2e-3);
  EXPECT_NEAR(std::hypot(apart.x, apart.y), 40.0 * 1480.0 / 1540.0, 0.06);
}

TEST(AssumedSoundSpeed, GainAndSmoothingAreByWhatIsShown)
{
  BModeSettings s;
  s.tgcDbPerCm = 4.0;
  s.axialSmoothingMm = 1.0;
  s.shownPerRange = 1450.0 / 1540.0;
  const double shownMm = 0.05;
  const double sampleMm = shownMm / s.shownPerRange;
  EXPECT_NEAR(depthGainDb(s, 401, sampleMm)[400], 8.0, 1e-9); // 400 samples are 2 cm
  const std::vector<float> weights = axialSmoothing(s, sampleMm);
  EXPECT_NEAR(weights[10], 0.5, 1e-6); // half a millimetre from its middle
}

TEST(AssumedSoundSpeed, TheDefaultChangesNothing)
{
  const ScanGeometry geometry;
  EXPECT_EQ(geometry.shownPerRange(), 1.0);
  EXPECT_EQ(geometry.rangeMm(), geometry.depthMm);
}

TEST(AssumedSoundSpeed, SaysWhatDoesNotFit)
{
  ImageInput input = inputOf(ScanKind::Linear, 1300.0);
  const auto scene = wallBehind(1540.0);
  Simulator simulator(std::shared_ptr<const Scene>(std::shared_ptr<void>(), scene.get()));
  expectContains(errorOf([&] { simulator.image(input); }), "assumedSoundSpeedMPerS is 1300");
  input.settings.geometry.assumedSoundSpeedMPerS = 1500.0; // the stages have not been told
  expectContains(errorOf([&] { simulator.image(input); }), "the stages disagree about the depth");
}
