#pragma once

#include "Probe/HeartLandmarks.h"
#include "Scene/Scene.h"

#include <string>
#include <vector>

namespace sono {

/// Something that a view has to show.
struct ViewDemand
{
  std::string structure;   ///< for sentences: "left ventricle"
  std::vector<int> labels; ///< ids
  Vec3d nearMm{ 0.0 };     ///< only what is near this point counts, world LPS mm
  double withinMm = 1e9;
  double leastPercent = 0.0; ///< of its section by the ideal plane, that a view must show
  double pull = 1.0;         ///< weight of its middle in where the image's axis points
};

/// A standard view as it ideally is, whether or not a probe can be put there. World LPS mm.
struct ViewPlan
{
  std::string name;    ///< "A4C"
  std::string title;   ///< "apical four-chamber"
  std::string preset;  ///< the probe, by the name of its preset file without extension
  std::string refusal; ///< one sentence: why the label map does not tell where it is; then the rest is empty

  Vec3d middleMm{ 0.0 };     ///< a point of the ideal plane
  Vec3d normal{ 0.0 };       ///< of the ideal plane, unit
  std::vector<Vec3d> points; ///< of the ideal plane, which a plane through a place on the skin keeps to; of a heart's
                             ///< views such that a degree off weighs as much as a millimetre from the mark
  Vec3d markMm{ 0.0 };       ///< how far a view is beside it is said: the apex; of a short axis its level's centre
  Vec3d look{ 0.0 };         ///< unit: which way a probe looks from the skin to the structures, within
  double lookDeg = 0.0;
  Vec3d rightward{ 0.0 };  ///< what is at the image's right
  double mostOffDeg = 0.0; ///< between the ideal plane and an obtainable one
  double mostOffMm = 0.0;  ///< of an obtainable plane from the mark
  std::vector<ViewDemand> demands;
};

/// The views of a heart with these landmarks, in the order A4C, A2C, A3C, A5C, PLAX, PSAX base, PSAX mid, PSAX apex,
/// SC4C. `parts` tells what they have to show; a view without one of its landmarks has a refusal.
///
/// With the apex a, the mitral annulus' centre m, the tricuspid t, the aortic o, and the long axis l from a to m:
/// A4C and SC4C contain a, m, t; A3C and PLAX a, m, o; A5C a, o and the direction of t across l; A2C l and the bisector
/// of the A4C and A3C planes on the side that the septum is not on (60 degrees from A4C where there is no aorta). PSAX
/// are across l, 85, 55 and 25 % of the way from a to m.
std::vector<ViewPlan> planHeartViews(const HeartLandmarks& landmarks, const LabelVolume& volume);

/// These, with one refusal for all where findHeartLandmarks refuses, and of the abdomen: IVC (subcostal, inferior vena
/// cava), RUQ (right kidney and liver), LUQ (left kidney and spleen), Suprapubic (bladder).
std::vector<ViewPlan> planStandardViews(const Scene& scene);

} // namespace sono
