#include "ErrorText.h"
#include "Folders.h"
#include "SmallImage.h"

#include "Echo/ComputedBeam.h"
#include "Image/GreyBytes.h"
#include "Image/LabelSlice.h"
#include "Simulator.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;
using test::busyScene;
using test::smallInput;

namespace {

/// A closed box around a point.
TargetSurface boxTarget(const Vec3d& centre)
{
  TargetSurface box{ "box", test::makeTissue("steel", 40.0, 5900.0, 0.1), {}, {} };
  for (int corner = 0; corner < 8; ++corner)
  {
    box.pointsMm.push_back(centre + Vec3d(corner & 1 ? 2.0 : -2.0, corner & 2 ? 2.0 : -2.0, corner & 4 ? 2.0 : -2.0));
  }
  box.triangles = { { 0, 2, 3 }, { 0, 3, 1 }, { 4, 5, 7 }, { 4, 7, 6 }, { 0, 1, 5 }, { 0, 5, 4 },
                    { 2, 6, 7 }, { 2, 7, 3 }, { 0, 4, 6 }, { 0, 6, 2 }, { 1, 3, 7 }, { 1, 7, 5 } };
  return box;
}

/// The handles of all stages.
struct Handles
{
  TracedResult traced;
  RfResult rf;
  BModeResult bmode;
  ImageResult image;
};

Handles ask(Simulator& simulator, const ImageInput& input)
{
  return { simulator.traced(input), simulator.rf(input), simulator.bmode(input), simulator.image(input) };
}

/// Which of four stages gave another result: "traced rf bmode image" or the part of it.
std::string changed(const Handles& a, const Handles& b)
{
  std::string names;
  names += a.traced == b.traced ? "" : "traced ";
  names += a.rf == b.rf ? "" : "rf ";
  names += a.bmode == b.bmode ? "" : "bmode ";
  names += a.image == b.image ? "" : "image ";
  return names;
}

const std::string all = "traced rf bmode image ";

} // namespace

TEST(Simulator, GivesWhatTheStagesGiveToTheBit)
{
  const ImageInput input = smallInput();
  const ImageSettings& s = input.settings;
  Simulator simulator(busyScene());
  const Handles handles = ask(simulator, input);

  const auto lines = makeScanLines(s.geometry, input.pose);
  const TracedLines traced = trace(*busyScene(), lines, s.tracing);
  const RfLines rf = formRf(*busyScene(), lines, traced, s.echo);
  const BModeLines bmode = makeBMode(rf.envelope(), rf.lineCount, rf.sampleCount, rf.sampleMm, s.bmode);
  const PlaneImage image = scanConvert(s.geometry, bmode.grey, bmode.sampleCount, bmode.sampleMm, s.pixelMm);
  EXPECT_EQ(handles.traced.host().intensity, traced.intensity);
  EXPECT_EQ(handles.traced.host().standardError, traced.standardError);
  EXPECT_EQ(handles.traced.host().boundaryEcho, traced.boundaryEcho);
  EXPECT_EQ(handles.rf.host().iq, rf.iq);
  EXPECT_EQ(handles.bmode.host().grey, bmode.grey);
  EXPECT_EQ(handles.bmode.host().referenceAmplitude, bmode.referenceAmplitude);
  EXPECT_EQ(handles.image.plane().host().value, image.value);
  EXPECT_EQ(handles.image.plane().host().mask, image.mask);

  const ScanPicture picture = simulator.picture(handles.image, input.settings.geometry, input.pose, handles.traced);
  const auto labels = sliceLabels(busyScene()->volume(), s.geometry, input.pose, image,
                                  { &traced.depthOffsetMm, traced.binCount, traced.binMm });
  EXPECT_EQ(std::vector<std::uint16_t>(picture.labels.begin(), picture.labels.end()), labels);
  EXPECT_EQ(std::vector<std::uint8_t>(picture.mask.begin(), picture.mask.end()), image.mask);
  ASSERT_EQ(picture.grey.size, image.value.size());
  for (std::size_t i = 0; i < image.value.size(); ++i)
  {
    const long level = std::max(1L, std::lround(255.0f * image.value[i]));
    ASSERT_EQ(picture.grey[i], image.mask[i] ? level : 0) << i;
  }
}

TEST(Simulator, TheSameSettingsGiveTheSameHandles)
{
  Simulator simulator(busyScene());
  const Handles first = ask(simulator, smallInput());
  EXPECT_EQ(changed(first, ask(simulator, smallInput())), "");
  const ScanPicture one = simulator.picture(first.image);
  EXPECT_EQ(simulator.picture(first.image).grey.data, one.grey.data);
}

TEST(Simulator, AChangeRunsTheStagesThatItConcerns)
{
  struct Case
  {
    const char* what;
    std::function<void(ImageInput&)> change;
    std::string runs;
  };
  const auto field = [] {
    FieldGrid grid;
    grid.lateral = grid.elevational = { 0.0, 1.0, 3 };
    grid.depth = { 0.0, 10.0, 7 };
    return std::make_shared<const PulseEchoField>(grid, std::vector<float>(grid.size(), 1.0f));
  };
  const std::vector<Case> cases = {
    { "pose", [](ImageInput& i) { i.pose.positionMm.x += 1.0; }, all },
    { "lines", [](ImageInput& i) { i.settings.geometry.lineCount = 7; }, all },
    { "paths", [](ImageInput& i) { i.settings.tracing.pathsPerLine = 65; }, all },
    { "path seed", [](ImageInput& i) { i.settings.tracing.seed = 2; }, all },
    { "targets",
      [](ImageInput& i) {
        i.targets.push_back(boxTarget({ 32.0, 24.0, 20.0 }));
      },
      all },
    { "scatterer seed", [](ImageInput& i) { i.settings.echo.seed = 2; }, "rf bmode image " },
    { "cell", [](ImageInput& i) { i.settings.echo.scattererCellMm = 0.6; }, "rf bmode image " },
    { "points",
      [](ImageInput& i) {
        i.points =
          std::make_shared<const PointScatterers>(std::vector<PointScatterer>{ { { 32.0, 24.0, 25.0 }, 1.0f } });
      },
      "rf bmode image " },
    { "field", [&](ImageInput& i) { i.settings.echo.field = field(); }, "rf bmode image " },
    { "gain", [](ImageInput& i) { i.settings.bmode.gainDb = 3.0; }, "bmode image " },
    { "lateral gain", [](ImageInput& i) { i.settings.bmode.lateralGainDb[3] = 3.0; }, "bmode image " },
    { "grey map",
      [](ImageInput& i) {
        i.settings.bmode.greyMap = { 0.0f, 0.8f, 1.0f };
      },
      "bmode image " },
    { "haze", [](ImageInput& i) { i.settings.bmode.addHaze = true; }, "bmode image " },
    { "noise",
      [](ImageInput& i) {
        i.settings.bmode.addNoise = true;
        i.settings.bmode.noiseDb = -80.0;
      },
      "bmode image " },
    { "pixels", [](ImageInput& i) { i.settings.pixelMm = 0.4; }, "image " },
  };
  for (const Case& c : cases)
  {
    Simulator simulator(busyScene());
    const Handles before = ask(simulator, smallInput());
    ImageInput input = smallInput();
    c.change(input);
    const Handles after = ask(simulator, input);
    EXPECT_EQ(changed(before, after), c.runs) << c.what;
    // As if nothing had been there before.
    Simulator fresh(busyScene());
    EXPECT_EQ(after.image.plane().host().value, fresh.image(input).plane().host().value) << c.what;
  }
}

TEST(Simulator, AnEqualTargetIsTheSame)
{
  Simulator simulator(busyScene());
  ImageInput input = smallInput();
  input.targets.push_back(boxTarget({ 32.0, 24.0, 20.0 }));
  const Handles before = ask(simulator, input);
  ImageInput again = smallInput();
  again.targets.push_back(boxTarget({ 32.0, 24.0, 20.0 }));
  EXPECT_EQ(changed(before, ask(simulator, again)), "");
  again.targets[0].tissue.impedanceMRayl = 30.0;
  EXPECT_EQ(changed(before, ask(simulator, again)), all);
}

TEST(Simulator, AnotherSceneForgetsTheResultsOfTheOneBefore)
{
  Simulator simulator(busyScene());
  const Handles before = ask(simulator, smallInput());
  simulator.setScene(busyScene());
  EXPECT_EQ(changed(before, ask(simulator, smallInput())), "");
  simulator.setScene(test::makeBusyScene());
  EXPECT_EQ(changed(before, ask(simulator, smallInput())), all);
}

TEST(Simulator, OtherTissuesOfASceneGiveWhatASceneOfTheirOwnDoes)
{
  TissueTable before;
  TissueTable after;
  for (Tissue tissue : busyScene()->tissues())
  {
    before.add(tissue);
    tissue.impedanceMRayl *= tissue.name == "air" ? 1.0 : 1.1;
    tissue.attenuationDbPerCmMHz += 0.3;
    tissue.fibreAnisotropyDb = 10.0 - tissue.fibreAnisotropyDb; // so that fibres come or go
    after.add(tissue);
  }
  const auto outside = busyScene()->outsideIndex();
  const std::string outsideName = outside < 0 ? "" : busyScene()->tissues()[std::size_t(outside)].name;
  const auto retuned = std::make_shared<Scene>(busyScene()->volume(), before, outsideName);
  ImageInput input = smallInput();
  input.settings.tracing.interactive = true;
  const auto first = Simulator(retuned).image(input).plane().host().value;
  const std::uint64_t id = retuned->id();
  retuned->setTissues(after);
  EXPECT_NE(retuned->id(), id);
  const auto own = std::make_shared<Scene>(busyScene()->volume(), after, outsideName);
  const auto again = Simulator(retuned).image(input).plane().host().value;
  EXPECT_EQ(again, Simulator(own).image(input).plane().host().value);
  EXPECT_NE(again, first);
  expectContains(errorOf([&] { retuned->setTissues({}); }), "the tissue table does not hold");
}

TEST(Simulator, HandlesOutliveWhatIsMadeNext)
{
  Simulator simulator(busyScene());
  ImageInput input = smallInput();
  const Handles first = ask(simulator, input);
  const std::vector<float> value = first.image.plane().host().value;
  const ScanPicture picture = simulator.picture(first.image);
  const std::vector<std::uint8_t> grey(picture.grey.begin(), picture.grey.end());
  input.settings.tracing.seed = 2;
  const Handles second = ask(simulator, input);
  simulator.picture(second.image);
  EXPECT_NE(second.image.plane().host().value, value);
  EXPECT_EQ(first.image.plane().host().value, value);
  EXPECT_EQ(std::vector<std::uint8_t>(picture.grey.begin(), picture.grey.end()), grey);
}

TEST(Simulator, AStopLeavesTheLastResults)
{
  Simulator simulator(busyScene());
  const Handles before = ask(simulator, smallInput());
  ImageInput input = smallInput();
  input.settings.tracing.pathsPerLine = 100000;
  EXPECT_THROW(simulator.image(input, [](double) { return false; }), Aborted);
  EXPECT_EQ(changed(before, ask(simulator, smallInput())), "");
}

TEST(Simulator, TheErrorMapIsThatOfTheTracedLines)
{
  Simulator simulator(busyScene());
  const ImageInput input = smallInput();
  const TracedResult traced = simulator.traced(input);
  const PlaneImage map = simulator.errorMap(input.settings.geometry, traced, false, 0.5).plane().host();
  // Straight below the face the middle line's bins follow each other.
  const TracedLines& lines = traced.host();
  const int column = map.width / 2;
  int compared = 0;
  for (int bin = 2; bin < lines.binCount - 2; ++bin)
  {
    const double depthMm = (bin + 0.5) * lines.binMm;
    const double row = (depthMm - map.axialMinMm) / map.pixelMm;
    const std::size_t at = std::size_t(4) * std::size_t(lines.binCount) + std::size_t(bin);
    if (std::abs(row - std::round(row)) < 1e-6 && map.width % 2 == 1)
    {
      const double percent = lines.intensity[at] > 0.0f
                               ? std::min(100.0, 100.0 * double(lines.standardError[at]) / lines.intensity[at])
                               : 100.0;
      EXPECT_NEAR(map.value[std::size_t(std::lround(row)) * std::size_t(map.width) + std::size_t(column)], percent,
                  1e-2 * percent + 1e-3)
        << bin;
      ++compared;
    }
  }
  EXPECT_EQ(compared > 0, map.width % 2 == 1);

  const PlaneImage unknown = simulator.errorMap(input.settings.geometry, traced, true, 0.5).plane().host();
  EXPECT_EQ(unknown.mask, std::vector<std::uint8_t>(map.mask.size(), 0));
}

TEST(Simulator, ASweepGivesThePicturesOfItsPoses)
{
  const ImageInput input = smallInput();
  std::vector<ProbePose> poses(3, input.pose);
  poses[1].positionMm.x += 2.0;
  poses[2].axial = glm::normalize(Vec3d(0.1, 0.0, 1.0));
  poses[2] = poses[2].orthonormalized();
  Simulator simulator(busyScene());
  int seen = 0;
  std::vector<double> fractions;
  simulator.sweep(
    poses, input.settings, true,
    [&](const SweptPictures& pictures) {
      for (int n = 0; n < pictures.count; ++n, ++seen)
      {
        ASSERT_EQ(pictures.firstPose + n, seen);
        Simulator alone(busyScene());
        ImageInput one = input;
        one.pose = poses[std::size_t(seen)];
        const ScanPicture picture = alone.picture(alone.image(one), one.settings.geometry, one.pose, alone.traced(one));
        const std::size_t first = std::size_t(n) * picture.grey.size;
        EXPECT_TRUE(std::equal(picture.grey.begin(), picture.grey.end(), pictures.grey + first)) << seen;
        EXPECT_TRUE(std::equal(picture.labels.begin(), picture.labels.end(), pictures.labels + first)) << seen;
        EXPECT_TRUE(std::equal(picture.mask.begin(), picture.mask.end(), pictures.mask)) << seen;
      }
    },
    [&](double fraction) {
      fractions.push_back(fraction);
      return true;
    });
  EXPECT_EQ(seen, 3);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));

  simulator.sweep(poses, input.settings, false,
                  [&](const SweptPictures& pictures) { EXPECT_EQ(pictures.labels, nullptr); });
  simulator.sweep({}, input.settings, false, [&](const SweptPictures&) { FAIL(); });
}

TEST(Simulator, SaysWhatDoesNotFit)
{
  Simulator simulator(busyScene());
  ImageInput input = smallInput();
  input.settings.tracing.depthMm = 40.0;
  expectContains(errorOf([&] { simulator.image(input); }), "disagree about the depth");
  input = smallInput();
  input.settings.tracing.frequencyMHz = 3.0;
  expectContains(errorOf([&] { simulator.image(input); }), "disagree about the frequency");
  input = smallInput();
  input.settings.echo.samplingMHz = 30.0;
  expectContains(errorOf([&] { simulator.image(input); }), "disagree about the sampling");

  input = smallInput();
  ProbePose away = input.pose;
  away.positionMm.z = -500.0;
  const auto sink = [](const SweptPictures&) {};
  expectContains(errorOf([&] { simulator.sweep({ input.pose, away }, input.settings, false, sink); }), "pose 1");
  input.settings.geometry.kind = ScanKind::Matrix;
  expectContains(errorOf([&] { simulator.sweep({ input.pose }, input.settings, false, sink); }), "volume");
  expectContains(errorOf([&] { Simulator().traced(smallInput()); }), "no scene");
}

TEST(StageResult, IsFetchedOnceByWhoeverAsksFirst)
{
  struct Lies
  {
    int number;
  };
  std::atomic<int> fetches{ 0 };
  const StageResult<std::vector<int>, Lies> result({}, std::make_shared<const Lies>(Lies{ 7 }),
                                                   [&](const Lies& lies, std::vector<int>& out) {
                                                     ++fetches;
                                                     out.assign(1000, lies.number);
                                                   });
  EXPECT_TRUE(result.layout().empty());
  EXPECT_EQ(fetches, 0);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
  {
    threads.emplace_back([&] { EXPECT_EQ(result.host(), std::vector<int>(1000, 7)); });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(fetches, 1);
}

TEST(StageResult, AFetchThatFailsIsTriedAgain)
{
  int tries = 0;
  const StageResult<int, int> result(0, std::make_shared<const int>(5), [&](const int& from, int& to) {
    if (++tries == 1)
    {
      throw Error("lost");
    }
    to = from;
  });
  EXPECT_THROW(result.host(), Error);
  EXPECT_EQ(result.host(), 5);
}

TEST(Simulator, ComputesTheBeamThatIsAskedFor)
{
  ImageInput input = smallInput();
  input.settings.echo.aperture = ProbeSettings().aperture();
  input.settings.matchStages();
  Simulator simulator(busyScene());
  const RfResult gaussian = simulator.rf(input);
  input.settings.echo.beam = BeamForm::Computed;
  const RfResult computed = simulator.rf(input);
  EXPECT_NE(computed.host().iq, gaussian.host().iq);
  EXPECT_TRUE(simulator.rf(input) == computed); // its table is kept

  // The elements of a P4-2, which have gaps: a beam nearly as theirs.
  ArrayAperture elements = apertureOf(readProbePreset(dataFile("probes/phased_p4-2.json")));
  const EchoSettings& echo = input.settings.echo;
  elements.centreFrequencyMHz = echo.centreFrequencyMHz;
  elements.fractionalBandwidth = echo.fractionalBandwidth;
  const ArrayField exact(elements, echo.depthMm);
  const ArrayField ours(elementsOf(echo), echo.depthMm);
  for (const double depthMm : { 20.0, 35.0, 50.0 })
  {
    const double peak = std::abs(exact.lateralAt(0.0, depthMm));
    for (const double lateralMm : { 0.0, 0.5, 1.0, 2.0, 4.0 })
    {
      EXPECT_NEAR(std::abs(ours.lateralAt(lateralMm, depthMm)) / peak,
                  std::abs(exact.lateralAt(lateralMm, depthMm)) / peak, 0.02)
        << depthMm << " mm, " << lateralMm << " mm to the side";
    }
  }

  input.settings.echo.aperture = {};
  input.settings.matchStages();
  expectContains(errorOf([&] { simulator.rf(input); }), "give its width and height, or choose the Gaussian beam");
}

TEST(Simulator, SweepsWithTheComputedBeamAsItImages)
{
  ImageInput input = smallInput();
  input.settings.echo.aperture = ProbeSettings().aperture();
  input.settings.echo.beam = BeamForm::Computed;
  input.settings.matchStages();
  Simulator simulator(busyScene());
  const ScanPicture alone = simulator.picture(simulator.image(input));
  std::vector<std::uint8_t> swept;
  simulator.sweep({ input.pose }, input.settings, false,
                  [&](const SweptPictures& p) { swept.assign(p.grey, p.grey + alone.grey.size); });
  EXPECT_EQ(swept, std::vector<std::uint8_t>(alone.grey.begin(), alone.grey.end()));
}
