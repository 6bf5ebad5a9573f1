#include "Labels/PrepareBody.h"

#include "Labels/BodyEnd.h"
#include "Labels/HeartByShape.h"
#include "Labels/LabelCode.h"

#include <utility>

namespace sono {

namespace {

/// What to say of tissues that are guesses; empty when none is.
std::string warningOfGuesses(const std::vector<LabelInfo>& labels)
{
  std::string guesses;
  bool nameless = false;
  for (const LabelInfo& label : labels)
  {
    if (label.guessed)
    {
      guesses += (guesses.empty() ? "" : ", ") + label.name + " (" + label.tissue + ")";
      nameless = nameless || saysNothing(label.name);
    }
  }
  if (guesses.empty())
  {
    return {};
  }
  return "These labels' tissues are guesses, to be changed in View > Ultrasound Tissues: " + guesses + "." +
         (nameless
            ? " The label map does not name them all: choose a list of names in its reader (Label Names), or put a "
              "table beside the file."
            : "");
}

/// With what to say of a heart that is solid muscle.
std::vector<std::string> withHeart(const LabelVolume& volume, std::vector<std::string> sentences)
{
  if (hasHeartWithoutChambers(volume))
  {
    sentences.emplace_back("The heart is one label without blood in it: its chambers are missing and will look like "
                           "muscle; take a segmentation that has chambers.");
  }
  return sentences;
}

} // namespace

std::vector<std::string> prepareBody(LabelVolume& volume, const LabelTissueMap& map, const TissueTable& table,
                                     const std::string& fallbackTissue, BodyFillMode fill,
                                     const BodyFillSettings& settings)
{
  std::vector<std::string> sentences;
  const std::string heart = guessHeart(volume);
  const std::vector<std::string> unmapped = assignTissues(volume, map, table, fallbackTissue);
  const std::string guesses = warningOfGuesses(volume.labels);
  if (!guesses.empty())
  {
    sentences.push_back(heart + (heart.empty() ? "" : " ") + guesses);
  }
  const BodyEnd end = fill == BodyFillMode::On ? BodyEnd::Skin : bodyEnd(volume, unmapped);
  if (fill == BodyFillMode::Off && end != BodyEnd::Skin)
  {
    sentences.emplace_back("The label map has no skin and Fill Body is Off: the probe stands on bare organs or on the "
                           "cut; set Fill Body to Auto or On, and press Find Window if the probe was moved.");
    return withHeart(volume, std::move(sentences));
  }
  if (end == BodyEnd::NoSkin)
  {
    fillBody(volume, settings);
    sentences.emplace_back(
      "The label map has no skin: its body was filled with soft tissue and skin, whose place is an "
      "estimate (Fill Body is Auto; Off leaves it as it is).");
  }
  else if (end == BodyEnd::BareOrgan)
  {
    batheOrgan(volume, settings);
    sentences.push_back("The label map holds a bare organ without a body around it: a bath of soft tissue, " +
                        std::to_string(int(bathMm)) +
                        " mm thick, was put around it (Fill Body is Auto; Off leaves it as it is).");
  }
  if (end != BodyEnd::Skin)
  {
    assignTissues(volume, map, table, fallbackTissue); // of what was added
  }
  return withHeart(volume, std::move(sentences));
}

} // namespace sono
