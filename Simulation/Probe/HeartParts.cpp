#include "Probe/HeartParts.h"

#include "Labels/LabelWords.h"

#include <algorithm>
#include <string>

namespace sono {
namespace {

/// The words of a label's name, asked for by their beginnings.
class NameWords
{
public:
  explicit NameWords(const std::string& name)
    : words_(wordsOfName(name))
  {
  }

  bool is(const char* word) const { return std::find(words_.begin(), words_.end(), word) != words_.end(); }
  bool begins(const std::string& with) const
  {
    return std::any_of(words_.begin(), words_.end(),
                       [&](const std::string& word) { return word.compare(0, with.size(), with) == 0; });
  }
  bool isLeft() const { return is("left") || is("l"); }
  bool isRight() const { return is("right") || is("r"); }
  bool isVentricle() const { return begins("ventric"); }
  bool isAtrium() const { return begins("atri"); }

private:
  std::vector<std::string> words_;
};

HeartPart cavity(const NameWords& name)
{
  if (name.begins("append") || name.begins("auric") || name.is("vein") || name.begins("arter"))
  {
    return HeartPart::None;
  }
  if (name.is("ivc") || name.is("postcava") || (name.is("inferior") && name.is("cava")))
  {
    return HeartPart::InferiorVenaCava;
  }
  if (name.begins("aort"))
  {
    return HeartPart::Aorta;
  }
  if (name.is("lv") || (name.isLeft() && name.isVentricle()))
  {
    return HeartPart::LeftVentricle;
  }
  if (name.is("rv") || (name.isRight() && name.isVentricle()))
  {
    return HeartPart::RightVentricle;
  }
  if (name.is("la") || (name.isLeft() && name.isAtrium()))
  {
    return HeartPart::LeftAtrium;
  }
  return name.is("ra") || (name.isRight() && name.isAtrium()) ? HeartPart::RightAtrium : HeartPart::None;
}

HeartPart wall(const NameWords& name)
{
  const bool isRight = name.is("rv") || name.isRight();
  if (name.begins("papillar"))
  {
    return isRight ? HeartPart::RightVentricle : HeartPart::LeftVentricle;
  }
  if (name.isAtrium() || name.begins("interatri") || name.is("la") || name.is("ra"))
  {
    return HeartPart::None;
  }
  return isRight ? HeartPart::RightWall : HeartPart::LeftWall;
}

HeartPart valve(const NameWords& name)
{
  return name.is("mitral") || name.is("bicuspid") ? HeartPart::MitralValve
         : name.is("tricuspid")                   ? HeartPart::TricuspidValve
         : name.begins("aort")                    ? HeartPart::AorticValve
                                                  : HeartPart::None;
}

HeartPart partOf(const LabelInfo& label)
{
  const NameWords name(label.name);
  return label.tissue == "blood"        ? cavity(name)
         : label.tissue == "myocardium" ? wall(name)
         : label.tissue == "valve"      ? valve(name)
                                        : HeartPart::None;
}

} // namespace

const char* nameOf(HeartPart part)
{
  constexpr const char* names[] = { "rest",
                                    "left ventricle",
                                    "wall of the left ventricle",
                                    "right ventricle",
                                    "wall of the right ventricle",
                                    "left atrium",
                                    "right atrium",
                                    "aorta",
                                    "mitral valve",
                                    "tricuspid valve",
                                    "aortic valve",
                                    "inferior vena cava" };
  return names[std::size_t(part)];
}

HeartParts::HeartParts(const std::vector<LabelInfo>& labels)
  : partOfId_(65536, HeartPart::None)
{
  for (const LabelInfo& label : labels)
  {
    const HeartPart part = partOf(label);
    partOfId_[std::size_t(label.id)] = part;
    has_[std::size_t(part)] = true;
  }
}

} // namespace sono
