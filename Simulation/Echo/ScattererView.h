#pragma once

namespace sono {

/// Scatterers side by side, positions in mm along the axes of their source. Owned elsewhere.
struct ScattererView
{
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  const float* amplitude = nullptr;
  int count = 0;
  float scale = 1.0f;    ///< of all amplitudes
  bool isPadded = false; ///< whether there is more behind, of any place and amplitude, to whole vectors (Core/Simd.h)
};

} // namespace sono
