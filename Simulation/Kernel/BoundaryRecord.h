#pragma once

#include "Kernel/HostDevice.h"
#include "Kernel/Vec.h"

#include <cmath>
#include <cstdint>

namespace sono {

/// What the smoothed surface of a tissue looks like at one of its boundary voxels.
struct BoundaryRecord
{
  Vec3f normal;     ///< unit, out of the tissue, local axes
  float offset;     ///< distance from the voxel's centre to the surface along the normal, in mean voxel sizes
  float confidence; ///< gradient of the smoothed occupancy relative to a plane's: 1 on a flat wall, 0 inside a thin one
};

/// Offsets are stored in steps of 1/256 voxel from -1/2 to 3/2: a voxel face, at 1/2, is exact.
constexpr float recordOffsetSteps = 256.0f;

SONO_HD inline float signNotZero(float x)
{
  return x >= 0.0f ? 1.0f : -1.0f;
}

/// A unit vector on the octahedron, unfolded to a square: both coordinates from -1 to 1.
SONO_HD inline Vec2f ontoOctahedron(const Vec3f& n)
{
  const float scale = 1.0f / (fabsf(n.x) + fabsf(n.y) + fabsf(n.z));
  const float u = n.x * scale;
  const float v = n.y * scale;
  return n.z < 0.0f ? Vec2f((1.0f - fabsf(v)) * signNotZero(u), (1.0f - fabsf(u)) * signNotZero(v)) : Vec2f(u, v);
}

/// Back, onto the octahedron instead of the sphere: its length is between 0.57 and 1.
SONO_HD inline Vec3f fromOctahedron(float u, float v)
{
  const float z = 1.0f - fabsf(u) - fabsf(v);
  const float fold = z < 0.0f ? z : 0.0f; // unfolds the lower half
  return { u + (u >= 0.0f ? fold : -fold), v + (v >= 0.0f ? fold : -fold), z };
}

/// 32 bits: octahedral normal 10 + 10 (0.1 degrees; 1022 steps hold the axes exactly), offset 9, confidence 3.
/// 0 means "no record", which a real record never encodes to (its offset bits are 1 to 511).
SONO_HD inline std::uint32_t encodeRecord(const BoundaryRecord& record)
{
  const Vec2f n = ontoOctahedron(record.normal);
  const std::uint32_t iu = std::uint32_t((n.x * 0.5f + 0.5f) * 1022.0f + 0.5f);
  const std::uint32_t iv = std::uint32_t((n.y * 0.5f + 0.5f) * 1022.0f + 0.5f);
  const float d = fminf(fmaxf((record.offset + 0.5f) * recordOffsetSteps + 0.5f, 1.0f), 511.0f);
  const std::uint32_t id = std::uint32_t(d);
  const std::uint32_t ic = std::uint32_t(fminf(fmaxf(record.confidence, 0.0f), 1.0f) * 7.0f + 0.5f);
  return iu | (iv << 10) | (id << 20) | (ic << 29);
}

/// The normal of a record, on the octahedron.
SONO_HD inline Vec3f decodeOctahedral(std::uint32_t bits)
{
  return fromOctahedron(float(bits & 1023u) * (2.0f / 1022.0f) - 1.0f,
                        float((bits >> 10) & 1023u) * (2.0f / 1022.0f) - 1.0f);
}

SONO_HD inline float decodeConfidence(std::uint32_t bits)
{
  return float(bits >> 29) * (1.0f / 7.0f);
}

SONO_HD inline BoundaryRecord decodeRecord(std::uint32_t bits)
{
  return { glm::normalize(decodeOctahedral(bits)), float((bits >> 20) & 511u) / recordOffsetSteps - 0.5f,
           decodeConfidence(bits) };
}

} // namespace sono
