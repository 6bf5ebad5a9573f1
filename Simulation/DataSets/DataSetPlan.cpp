#include "DataSets/DataSetPlan.h"

#include "Phantoms/DrawThorax.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace sono {

namespace {

/// ceil(a / b).
std::int64_t atLeastPart(std::int64_t a, std::int64_t b)
{
  return (a + b - 1) / b;
}

} // namespace

ThoraxParameters thoraxOf(const PlannedBody& body)
{
  return body.thoraxSeed ? drawThoraxParameters(*body.thoraxSeed) : ThoraxParameters{};
}

DataSetPlan::DataSetPlan(DataSet set)
  : set_(std::move(set))
  , base_(baseSettings(set_))
{
  const std::uint32_t thoraxKey = drawKey("thorax");
  for (std::size_t p = 0; p < set_.patients.size(); ++p)
  {
    const DataSetPatient& patient = set_.patients[p];
    for (int copy = 0; copy < patient.copies; ++copy)
    {
      const auto number = std::int64_t(bodies_.size());
      PlannedBody body{ int(p), copy, patient.split.value_or(Split::Train), augmentationOf(patient, number), {} };
      if (patient.isDrawn)
      {
        body.thoraxSeed = drawSeed(set_.seed, DrawScope::Body, number, thoraxKey);
      }
      bodies_.push_back(body);
    }
  }
  for (const DrawnParameter& parameter : set_.parameters)
  {
    keys_.push_back(drawKey(std::string(nameOf(parameter.group)) + "." + parameter.name));
  }
  std::size_t at = 0;
  const PoseJitter names;
  PoseJitter::visit(names, [&](double, const char* name) { jitterKeys_[at++] = drawKey(name); });
  while (std::pow(10.0, digits_) < double(imageCount()))
  {
    ++digits_;
  }
  dealSplits();
}

BodyAugmentation DataSetPlan::augmentationOf(const DataSetPatient& patient, std::int64_t body) const
{
  const auto draw = [&](const Draw& drawn, const char* name) {
    return drawn.at(drawUniform(set_.seed, DrawScope::Body, body, drawKey(name)));
  };
  BodyAugmentation augmentation;
  augmentation.stretch =
    Vec3d(draw(patient.stretch, "stretch i"), draw(patient.stretch, "stretch j"), draw(patient.stretch, "stretch k"));
  augmentation.extraFatMm = draw(patient.extraFatMm, "extraFatMm");
  augmentation.warpAmplitudeMm = draw(patient.warpAmplitudeMm, "warp amplitudeMm");
  augmentation.warpWavelengthMm = draw(patient.warpWavelengthMm, "warp wavelengthMm");
  augmentation.warpSeed = drawSeed(set_.seed, DrawScope::Body, body, drawKey("warp"));
  augmentation.isMirrored = draw(patient.mirror, "mirror") > 0.0;
  return augmentation;
}

/// A patient is in one split alone: of label maps with all copies; copies of the bundled body are patients each.
void DataSetPlan::dealSplits()
{
  std::vector<std::vector<int>> units; // bodies that stay together
  for (std::size_t b = 0; b < bodies_.size(); ++b)
  {
    const DataSetPatient& patient = set_.patients[std::size_t(bodies_[b].patient)];
    if (patient.split)
    {
      continue;
    }
    if (units.empty() || patient.labels.empty() || bodies_[b].copy == 0)
    {
      units.emplace_back();
    }
    units.back().push_back(int(b));
  }
  std::vector<std::size_t> order(units.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  const auto chance = [&](std::size_t unit) {
    return drawUniform(set_.seed, DrawScope::Split, std::int64_t(units[unit].front()), 0);
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return chance(a) < chance(b); });
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const double place = (double(i) + 0.5) / double(order.size());
    const Split split = place < set_.splitShares[0]                         ? Split::Train
                        : place < set_.splitShares[0] + set_.splitShares[1] ? Split::Validation
                                                                            : Split::Test;
    for (const int body : units[order[i]])
    {
      bodies_[std::size_t(body)].split = split;
    }
  }
}

const DataSetPatient& DataSetPlan::patientOf(int body) const
{
  return set_.patients[std::size_t(bodies_[std::size_t(body)].patient)];
}

int DataSetPlan::bodyOf(std::int64_t exam) const
{
  return int(exam * std::int64_t(bodies_.size()) / set_.exams);
}

Split DataSetPlan::splitOf(std::int64_t image) const
{
  return bodies_[std::size_t(bodyOf(image / set_.imagesPerExam))].split;
}

std::int64_t DataSetPlan::imagesIn(Split split) const
{
  std::int64_t exams = 0;
  const auto count = std::int64_t(bodies_.size());
  for (std::int64_t b = 0; b < count; ++b)
  {
    // Of the exams e with floor(e B / E) = b.
    const std::int64_t first = atLeastPart(b * set_.exams, count);
    const std::int64_t end = atLeastPart((b + 1) * set_.exams, count);
    exams += bodies_[std::size_t(b)].split == split ? end - first : 0;
  }
  return exams * set_.imagesPerExam;
}

void DataSetPlan::requireImage(std::int64_t index) const
{
  if (index < 0 || index >= imageCount())
  {
    throw Error("'" + set_.path + "': there is no image " + std::to_string(index) + "; choose 0 to " +
                std::to_string(imageCount() - 1) + ".");
  }
}

PlannedImage DataSetPlan::image(std::int64_t index) const
{
  static const std::uint32_t pathKey = drawKey("pathSeed");
  static const std::uint32_t noiseKey = drawKey("noiseSeed");
  static const std::uint32_t scattererKey = drawKey("scattererSeed");
  PlannedImage image;
  image.index = index;
  image.exam = index / set_.imagesPerExam;
  image.body = bodyOf(image.exam);
  image.view = int((index % set_.imagesPerExam) % std::int64_t(patientOf(image.body).views.size()));
  image.parameters.reserve(set_.parameters.size());
  for (std::size_t p = 0; p < set_.parameters.size(); ++p)
  {
    const DrawnParameter& parameter = set_.parameters[p];
    const bool ofExam = parameter.group == SettingsGroup::Probe;
    const double uniform =
      drawUniform(set_.seed, ofExam ? DrawScope::Exam : DrawScope::Image, ofExam ? image.exam : index, keys_[p]);
    image.parameters.push_back(parameter.draw.at(uniform));
  }
  image.pathSeed = drawSeed(set_.seed, DrawScope::Image, index, pathKey);
  image.noiseSeed = drawSeed(set_.seed, DrawScope::Image, index, noiseKey);
  image.scattererSeed = drawSeed(set_.seed, DrawScope::Exam, image.exam, scattererKey);
  return image;
}

PoseJitter DataSetPlan::jitter(std::int64_t index, int attempt) const
{
  PoseJitter jitter;
  std::size_t at = 0;
  PoseJitter::visit(jitter, [&](double& value, const char*) {
    value =
      set_.jitter[at].at(drawUniform(set_.seed, DrawScope::Image, index, jitterKeys_[at], std::uint32_t(attempt)));
    ++at;
  });
  return jitter;
}

DataSetSettings DataSetPlan::settings(const PlannedImage& image) const
{
  DataSetSettings settings = base_;
  for (std::size_t p = 0; p < set_.parameters.size(); ++p)
  {
    settings.set(set_.parameters[p].group, set_.parameters[p].name, image.parameters[p]);
  }
  settings.tracing.seed = image.pathSeed;
  settings.echo.seed = image.scattererSeed;
  settings.display.noiseSeed = image.noiseSeed;
  return settings;
}

DataSetSettings DataSetPlan::deepest() const
{
  DataSetSettings settings = base_;
  for (const DrawnParameter& parameter : set_.parameters)
  {
    settings.set(parameter.group, parameter.name, parameter.draw.most());
  }
  return settings;
}

PlaneImage DataSetPlan::layout(const PlannedImage& image) const
{
  return planeImageLayout(settings(image).probe.geometry, set_.pixelMm);
}

TissueTable DataSetPlan::tissues(std::int64_t exam) const
{
  TissueTable table;
  for (Tissue tissue : set_.tissues.tissues())
  {
    for (const DrawnTissue& drawn : set_.drawnTissues)
    {
      if (drawn.tissue == tissue.name || (drawn.tissue == "*" && tissue.name != couplingTissue))
      {
        const std::uint32_t key = drawKey("tissues." + tissue.name + "." + drawn.column.name);
        const double value = drawn.draw.at(drawUniform(set_.seed, DrawScope::Exam, exam, key));
        double& number = tissue.*drawn.column.member;
        number = drawn.isFactor ? number * value : value;
      }
    }
    table.add(tissue);
  }
  return table;
}

std::string DataSetPlan::caseName(std::int64_t index) const
{
  const std::string number = std::to_string(index);
  return set_.name + "_" + std::string(std::size_t(digits_) - number.size(), '0') + number;
}

PlannedRange DataSetPlan::imagesOf(const DataSetShare& share) const
{
  if (share.of < 1 || share.rank < 0 || share.rank >= share.of)
  {
    throw Error("process " + std::to_string(share.rank) + " of " + std::to_string(share.of) +
                " is none: they are numbered from 0 to one less than there are.");
  }
  return { set_.exams * share.rank / share.of * set_.imagesPerExam,
           set_.exams * (share.rank + 1) / share.of * set_.imagesPerExam };
}

} // namespace sono
