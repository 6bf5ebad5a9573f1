#pragma once

#include <cstdint>

namespace sono {

/// Label ids of the bundled anatomy; names and colours stand in ThoraxPhantom.cpp. Ribs 1 to 10 of a side have
/// consecutive ids from RibLeft1 and RibRight1.
enum ThoraxLabel : std::uint16_t
{
  Background,
  Skin,
  SubcutaneousFat,
  Muscle,
  Sternum,
  CostalCartilages,
  Vertebrae,
  SpinalCord,
  LungLeft,
  LungRight,
  MediastinalFat,
  Pericardium,
  LeftVentricleMyocardium,
  InterventricularSeptum,
  RightVentricleMyocardium,
  LeftAtriumWall,
  RightAtriumWall,
  InteratrialSeptum,
  LeftVentricleBlood,
  RightVentricleBlood,
  LeftAtriumBlood,
  RightAtriumBlood,
  MitralValve,
  TricuspidValve,
  AorticValve,
  PapillaryMuscleAnterolateral,
  PapillaryMusclePosteromedial,
  PapillaryMuscleRight,
  AortaLumen,
  AortaWall,
  Liver,
  Stomach,
  VisceralFat,
  RibLeft1,
  RibRight1 = RibLeft1 + 10,
  ThoraxLabelCount = RibRight1 + 10
};

} // namespace sono
