#pragma once

#include "Scene/Scene.h"

#include <optional>
#include <string>
#include <vector>

namespace sono {

/// What a probe is to look at: labels, or a point.
struct WindowTarget
{
  std::string name;             ///< for sentences: "right kidney"
  std::vector<int> labels;      ///< ids, ascending; empty: the point
  std::optional<Vec3d> pointMm; ///< world LPS mm
  /// The probe that a sonographer would take, by the name of its preset file without extension; empty: any.
  std::string preset;
  /// What a sonographer takes where that reaches too little of it; empty: nothing else.
  std::string deepPreset;
};

/// The target of a name: an organ ("heart", "right kidney", "carotid"), or any label by words of its name, in any
/// order and number ("kidney right", "Left rib 6"). A heart or liver that no name tells is found by its tissue. An
/// empty name: the heart, where there is none the liver, instead of the tip of one a kidney, where there is none of
/// them all tissue but the outside one. Throws Error, with the names that there are, where nothing has that name, and
/// when there is nothing but what is outside.
WindowTarget windowTarget(const Scene& scene, const std::string& name);

/// A point and what is around it.
WindowTarget windowTarget(const Vec3d& pointMm);

/// Names that windowTarget takes for this scene: the organs that it has, then its labels' own.
std::vector<std::string> windowTargetNames(const Scene& scene);

} // namespace sono
