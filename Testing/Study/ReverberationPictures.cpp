// What textbooks show of reverberation and of the harmonic, each beside the same without it.
#include "ReverberationScenes.h"

#include "Picture.h"
#include "Study.h"

#include <algorithm>
#include <cmath>

namespace sono::study {
namespace {

constexpr double serousMm = 0.01; ///< roughness of pleura and diaphragm: a wet serous membrane, chosen
constexpr int panelHeight = 205;

double decibels(double power)
{
  return 10.0 * std::log10(std::max(power, 1e-30));
}

/// Mean power over some lines at each sample.
std::vector<double> powerOf(const RfLines& rf, int firstLine, int lastLine)
{
  std::vector<double> power(std::size_t(rf.sampleCount));
  for (int l = firstLine; l <= lastLine; ++l)
  {
    for (int s = 0; s < rf.sampleCount; ++s)
    {
      power[std::size_t(s)] += std::norm(rf.iq[std::size_t(l) * rf.sampleCount + s]) / (lastLine - firstLine + 1);
    }
  }
  return power;
}

double meanBetween(const std::vector<double>& power, double sampleMm, double fromMm, double toMm)
{
  double sum = 0.0;
  const int first = int(fromMm / sampleMm);
  const int last = std::min(int(toMm / sampleMm), int(power.size()));
  for (int s = first; s < last; ++s)
  {
    sum += power[std::size_t(s)];
  }
  return sum / std::max(last - first, 1);
}

double loudestBetween(const std::vector<double>& power, double sampleMm, double fromMm, double toMm)
{
  const auto last = power.begin() + std::min(int(toMm / sampleMm), int(power.size()));
  return double(std::max_element(power.begin() + int(fromMm / sampleMm), last) - power.begin()) * sampleMm;
}

/// Panels of one scene share the white of the first.
struct Drawn
{
  Picture picture;
  RfLines rf;
  double white;
};

Drawn draw(Simulator& simulator, ImageInput input, double white = 0.0)
{
  BModeSettings& bmode = input.settings.bmode;
  bmode.automaticReference = white == 0.0;
  bmode.referenceAmplitude = white == 0.0 ? 1.0 : white;
  const PlaneExtent extent = planeExtent(input.settings.geometry);
  input.settings.pixelMm = (extent.axialMaxMm - extent.axialMinMm) / panelHeight;
  const PlaneImage plane = simulator.image(input).plane().host();
  return { pictureOf(plane), simulator.rf(input).host(), simulator.bmode(input).host().referenceAmplitude };
}

/// Without reverberation and with it.
struct Pair
{
  Drawn without;
  Drawn with;
};

Pair drawPair(const ArtefactScene& artefact)
{
  Simulator simulator(artefact.scene);
  ImageInput input = artefact.input;
  input.settings.tracing.reverberation = true;
  Drawn with = draw(simulator, input);
  input.settings.tracing.reverberation = false;
  Drawn without = draw(simulator, input, with.white);
  return { std::move(without), std::move(with) };
}

/// Where the pleura and its repetitions are, and how far they stand out.
void figuresOfLung(Output& output, const std::string& name, const RfLines& rf)
{
  const int middle = rf.lineCount / 2;
  const int aside = rf.lineCount / 10;
  const std::vector<double> power = powerOf(rf, middle - aside, middle + aside);
  const double pleura = loudestBetween(power, rf.sampleMm, pleuraMm - 1.5, pleuraMm + 1.5);
  const double level = decibels(power[std::size_t(std::lround(pleura / rf.sampleMm))]);
  output.figure(name + "_pleura_mm", pleura, "mm");
  for (int n = 2; n <= 4; ++n)
  {
    const double at = loudestBetween(power, rf.sampleMm, n * pleura - 1.5, n * pleura + 1.5);
    const double above = decibels(power[std::size_t(std::lround(at / rf.sampleMm))]);
    const double around = decibels(0.5 * (meanBetween(power, rf.sampleMm, n * pleura - 4.0, n * pleura - 2.0) +
                                          meanBetween(power, rf.sampleMm, n * pleura + 2.0, n * pleura + 4.0)));
    const std::string line = name + "_aline_" + std::to_string(n);
    output.figure(line + "_depths_of_the_pleura", at / pleura, "");
    output.figure(line + "_a_repetition_db", (above - level) / (n - 1), "dB");
    output.figure(line + "_above_its_surroundings_db", above - around, "dB");
  }
}

/// Where the ball's mirror image lies, and how bright what is mirrored is.
void figuresOfMirror(Output& output, const std::string& name, const ArtefactScene& artefact, const RfLines& rf)
{
  const ImageSettings& s = artefact.input.settings;
  const MirrorPlace expected = ballBehindDiaphragm(s.geometry, artefact.input.pose);
  const int line = std::clamp(expected.line, 2, rf.lineCount - 3);
  std::vector<double> power = powerOf(rf, line - 2, line + 2);
  for (std::size_t n = 0; n < power.size(); ++n)
  {
    power[n] *= std::pow(10.0, 0.01 * s.bmode.tgcDbPerCm * double(n) * rf.sampleMm);
  }
  double moment = 0.0;
  double sum = 0.0;
  for (int n = int((expected.imageMm - 12.0) / rf.sampleMm);
       n < std::min(int((expected.imageMm + 12.0) / rf.sampleMm), rf.sampleCount); ++n)
  {
    moment += power[std::size_t(n)] * n * rf.sampleMm;
    sum += power[std::size_t(n)];
  }
  output.figure(name + "_mirror_mm", sum > 0.0 ? moment / sum : 0.0, "mm");
  output.figure(name + "_mirror_theory_mm", expected.imageMm, "mm");
  const double depth = expected.diaphragmMm;
  output.figure(name + "_mirrored_liver_to_liver_db",
                decibels(meanBetween(power, rf.sampleMm, depth + 3.0, depth + 9.0)) -
                  decibels(meanBetween(power, rf.sampleMm, depth - 9.0, depth - 3.0)),
                "dB");
}

/// The tail behind a piece of steel, around a line.
void figuresOfSteel(Output& output, const std::string& name, const Pair& steel, int line)
{
  const RfLines& rf = steel.with.rf;
  const int least = std::max(0, line - 2);
  const int most = std::min(rf.lineCount - 1, line + 2);
  const std::vector<double> with = powerOf(rf, least, most);
  const std::vector<double> without = powerOf(steel.without.rf, least, most);
  const double front = loudestBetween(with, rf.sampleMm, needleTopMm - 0.6, needleTopMm + 0.6);
  const double frontDb = decibels(with[std::size_t(std::lround(front / rf.sampleMm))]);
  const double spacing = needleThickMm * 1540.0 / 5790.0;
  output.figure(name + "_spacing_theory_mm", spacing, "mm");
  for (int n = 1; n <= 8; ++n)
  {
    const double expected = front + n * spacing;
    const double at = loudestBetween(with, rf.sampleMm, expected - 0.4 * spacing, expected + 0.4 * spacing);
    const std::string echo = name + "_echo_" + std::to_string(n);
    output.figure(echo + "_spacings_behind", (at - front) / spacing, "");
    output.figure(echo + "_db", decibels(with[std::size_t(std::lround(at / rf.sampleMm))]) - frontDb, "dB");
  }
  for (const double behind : { 3.0, 5.0, 10.0 })
  {
    const std::string at = "_at_" + number(behind) + "_mm_db";
    const double from = front + behind;
    output.figure(name + "_tail" + at, decibels(meanBetween(with, rf.sampleMm, from, from + 1.0)) - frontDb, "dB");
    output.figure(name + "_without" + at, decibels(meanBetween(without, rf.sampleMm, from, from + 1.0)) - frontDb,
                  "dB");
  }
}

/// Mean power in the cyst against that in the liver at the same depth, dB.
double cystDb(const ArtefactScene& artefact, const RfLines& rf)
{
  const std::vector<ScanLine> lines = makeScanLines(artefact.input.settings.geometry, artefact.input.pose);
  double inside = 0.0;
  double beside = 0.0;
  int insideCount = 0;
  int besideCount = 0;
  for (int l = 0; l < rf.lineCount; ++l)
  {
    for (int n = 0; n < rf.sampleCount; ++n)
    {
      const Vec3d p = lines[std::size_t(l)].originMm + n * rf.sampleMm * lines[std::size_t(l)].axis;
      const double power = std::norm(rf.iq[std::size_t(l) * rf.sampleCount + n]);
      const double away = glm::distance(p, cystMm);
      const bool level = std::abs(p.z - cystMm.z) < 0.5 * cystRadiusMm;
      inside += away < 0.5 * cystRadiusMm ? power : 0.0;
      insideCount += away < 0.5 * cystRadiusMm;
      beside += level && away > 1.75 * cystRadiusMm ? power : 0.0;
      besideCount += level && away > 1.75 * cystRadiusMm;
    }
  }
  return decibels(inside / std::max(insideCount, 1)) - decibels(beside / std::max(besideCount, 1));
}

/// Mean power, dB, of what lies in a label, as the picture's gain has it.
double labelDb(const ArtefactScene& artefact, const RfLines& rf, const std::string& label)
{
  const LabelVolume& volume = artefact.scene->volume();
  const std::vector<ScanLine> lines = makeScanLines(artefact.input.settings.geometry, artefact.input.pose);
  double sum = 0.0;
  int count = 0;
  for (int l = 0; l < rf.lineCount; ++l)
  {
    for (int n = 0; n < rf.sampleCount; n += 8)
    {
      const Vec3d p = lines[std::size_t(l)].originMm + n * rf.sampleMm * lines[std::size_t(l)].axis;
      const Vec3i voxel(glm::round(volume.placement.indexFromWorld(p)));
      const Vec3i size = volume.placement.size;
      if (glm::any(glm::lessThan(voxel, Vec3i(0))) || glm::any(glm::greaterThanEqual(voxel, size)))
      {
        continue;
      }
      const auto id = volume.voxels[(std::size_t(voxel.z) * size.y + voxel.y) * size.x + voxel.x];
      if (volume.find(id)->name.rfind(label, 0) == 0)
      {
        sum += std::norm(rf.iq[std::size_t(l) * rf.sampleCount + n]) *
               std::pow(10.0, 0.01 * artefact.input.settings.bmode.tgcDbPerCm * n * rf.sampleMm);
        ++count;
      }
    }
  }
  return decibels(sum / std::max(count, 1));
}

/// Levels of the left ventricle's wall and cavity, and of the atrium behind it.
void figuresOfHeart(Output& output, const std::string& name, const ArtefactScene& chest, const RfLines& rf)
{
  const double cavity = labelDb(chest, rf, "left_ventricle_blood");
  output.figure("a4c_" + name + "_wall_less_cavity_db", labelDb(chest, rf, "left_ventricle_myocardium") - cavity, "dB");
  output.figure("a4c_" + name + "_cavity_db", cavity, "dB");
  output.figure("a4c_" + name + "_left_atrium_db", labelDb(chest, rf, "left_atrium_blood"), "dB");
}

void run(Output& output)
{
  const bool quick = output.quick();
  const double bundledMm = TissueTable::read(dataFile("tissues.csv")).find("lung")->roughnessMm;
  const Pair lung = drawPair(pleuraScene(serousMm, quick));
  figuresOfLung(output, "smooth", lung.with.rf);
  const Pair roughLung = drawPair(pleuraScene(bundledMm, quick));
  figuresOfLung(output, "rough", roughLung.with.rf);

  const ArtefactScene dome = diaphragmScene(serousMm, quick);
  const Pair diaphragm = drawPair(dome);
  figuresOfMirror(output, "smooth", dome, diaphragm.with.rf);
  const ArtefactScene roughDome = diaphragmScene(bundledMm, quick);
  const Pair roughDiaphragm = drawPair(roughDome);
  figuresOfMirror(output, "rough", roughDome, roughDiaphragm.with.rf);

  const Pair needle = drawPair(needleScene(quick));
  figuresOfSteel(output, "needle", needle, int(0.26 * needle.with.rf.lineCount));
  figuresOfSteel(output, "strip", needle, int(0.74 * needle.with.rf.lineCount));

  const ArtefactScene fundamental = cystScene(ImagingMode::Fundamental, quick);
  const ArtefactScene harmonic = cystScene(ImagingMode::Harmonic, quick);
  const Pair sent = drawPair(fundamental);
  const Pair twice = drawPair(harmonic);
  output.figure("cyst_fundamental_db", cystDb(fundamental, sent.with.rf), "dB");
  output.figure("cyst_harmonic_db", cystDb(harmonic, twice.with.rf), "dB");
  output.figure("cyst_fundamental_without_reverberation_db", cystDb(fundamental, sent.without.rf), "dB");
  output.figure("cyst_harmonic_without_reverberation_db", cystDb(harmonic, twice.without.rf), "dB");

  const ArtefactScene chest = heartScene(quick);
  const Pair heart = drawPair(chest);
  figuresOfHeart(output, "without_reverberation", chest, heart.without.rf);
  figuresOfHeart(output, "with_reverberation", chest, heart.with.rf);

  writePicture(montage({ lung.without.picture, diaphragm.without.picture, needle.without.picture, sent.with.picture,
                         heart.without.picture, lung.with.picture, diaphragm.with.picture, needle.with.picture,
                         twice.with.picture, heart.with.picture },
                       5),
               output.file("reverberation.png"));
  writePicture(montage({ roughLung.with.picture, roughDiaphragm.with.picture }, 2),
               output.file("reverberation_rough.png"));
}

const Part part("reverberation", run);

} // namespace
} // namespace sono::study
