#pragma once

#include "Labels/LabelVolume.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sono {

/// What a label is to an echocardiographer.
enum class HeartPart : std::uint8_t
{
  None,
  LeftVentricle,  ///< its cavity, with papillary muscles
  LeftWall,       ///< of the left ventricle, with the septum
  RightVentricle, ///< its cavity, with papillary muscles
  RightWall,
  LeftAtrium,
  RightAtrium,
  Aorta, ///< its lumen, or all of it where it is one label
  MitralValve,
  TricuspidValve,
  AorticValve,
  InferiorVenaCava
};

/// "left ventricle"; of a wall "wall of the left ventricle".
const char* nameOf(HeartPart part);

/// The parts of a heart that a label map has, by the words of its labels' names and by their tissues: "blood" is a
/// cavity, "myocardium" a wall, "valve" a valve. Names may say the side and the chamber in any order, or "lv", "rv",
/// "la", "ra"; a myocardium that names no chamber is the left ventricle's. Auricles, veins and arteries are no parts.
class HeartParts
{
public:
  /// Of labels with tissues (see assignTissues).
  explicit HeartParts(const std::vector<LabelInfo>& labels);

  HeartPart of(std::uint16_t labelId) const { return partOfId_[labelId]; }
  bool has(HeartPart part) const { return has_[std::size_t(part)]; }

private:
  std::vector<HeartPart> partOfId_;
  std::array<bool, 16> has_{};
};

} // namespace sono
