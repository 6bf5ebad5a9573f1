#pragma once

#include "Scene/Lanes.h"

#include <vector>

namespace sono::stepfit {

constexpr int widest = 40; // voxels to each side of a column

/// Weights of a window's columns, (2 R + 1)^2: round, and falling to the rim, so that what enters a window comes
/// gently. Not faster: the steps that tell a slope best are the outer ones.
struct Window
{
  const float* weight;
  const float* strictness; ///< what of a column's excess counts
  float total;             ///< of the weights
};

/// Whoever takes columns as lanes do reads so far beyond a window at most.
constexpr int mostLanes = 32;

/// All windows' numbers one after the other, and where those of a radius, 0 to `widest`, begin. `mostLanes` zeros end
/// them.
struct WindowTables
{
  std::vector<float> weight;
  std::vector<float> strictness;
  std::vector<float> total;
  std::vector<std::size_t> first;

  WindowTables();
  /// By radius; with the numbers of other arrays, which hold the same.
  std::vector<Window> windows(const float* weights, const float* strictnesses) const;
};

const WindowTables& windowTables();
/// Of those, by radius.
const Window* hostWindows();

} // namespace sono::stepfit
