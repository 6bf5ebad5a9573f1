#pragma once

#include "Labels/LabelVolume.h"

namespace sono {

/// Small phantoms that show one thing each. Like the calibration phantom they have the world's axes, and the probe
/// stands at the origin and looks along z.
enum class TestObject
{
  EnhancementSphere, ///< a ball of water in gel: what lies behind it is lit more strongly
  ShadowSphere,      ///< a ball of bone in gel: nothing behind it is lit
  Rib,               ///< skin, fat and muscle over liver, with a rib across the beam
  SpeckleCube,       ///< 40 mm of scatterers that are all alike
  Neck               ///< thyroid with a nodule, trachea, carotids, jugular veins, muscles and a vertebra
};

struct TestObjectSettings
{
  double spacingMm = 0.5;   ///< edge of a voxel, 0.1 to 5
  double diameterMm = 20.0; ///< of a sphere, 1 to 60
  double depthMm = 40.0;    ///< of a sphere's centre, more than its radius and at most 110

  /// Throws Error naming the parameter and its range.
  void validate() const;
};

/// The object's label map, its labels named by their tissues, those of the neck by their structures. Spheres lie in gel
/// of 100 x 80 x 120 mm, the rib in 120 x 60 x 120 mm, both below the surface z = 0; the neck is 100 x 50 x 60 mm.
/// Throws Error for settings out of range.
LabelVolume makeTestObject(TestObject object, const TestObjectSettings& settings = {});

} // namespace sono
