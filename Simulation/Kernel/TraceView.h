#pragma once

#include "Kernel/Interface.h"
#include "Kernel/Lobe.h"
#include "Kernel/Vec.h"

#include <cstdint>

namespace sono {

/// A tissue as the tracer needs it.
struct TraceMedium
{
  float impedance = 1.5f;  ///< MRayl
  float speed = 1540.0f;   ///< m/s
  float decayPerMm = 0.0f; ///< k: intensity falls by exp(-k l)
  float tau = 1.0f;
  float gamma = 0.0f;
};

/// One main beam (see ScanLine) in the region's local millimetres; the axis is a unit vector.
struct TraceLine
{
  Vec3f origin;
  Vec3f axis;
};

/// Everything a path needs beside the space it runs through, trivially copyable.
struct TraceView
{
  const TraceMedium* media = nullptr; ///< by tissue index, then one for each target
  int firstTargetMedium = 0;
  int outsideTissue = -1;
  float rouletteIntensity = 1e-5f; ///< fainter paths survive with probability intensity / this
  InterfaceModel model = InterfaceModel::Acoustic;
  Lobe lobe;
  bool lowDiscrepancy = true;
  bool deterministic = false;
  int maxCollisions = 7;
  float coherenceMm = 0.1f;
  float depthMm = 160.0f;
  std::uint64_t seed = 1;
};

/// w_R = C0 / (C0 + distance) (Data/docs/physics.md section 3). A micrometre is on the axis: C0 = 0 keeps exactly that.
SONO_HD inline float coherenceWeight(float c0, float distance)
{
  return distance < 1e-3f ? 1.0f : c0 / (c0 + distance);
}

} // namespace sono
