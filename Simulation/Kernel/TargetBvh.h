#pragma once

#include "Kernel/CellSpace.h"

#include <cmath>
#include <cstdint>

namespace sono {

/// A node of a bounding volume hierarchy over triangles: an inner node's children are `first` and `first + 1`; a leaf
/// (count > 0) holds the triangles [first, first + count).
struct BvhNode
{
  Vec3f low;
  Vec3f high;
  std::int32_t first;
  std::int32_t count;
};

/// A triangle, counter-clockwise seen from outside its target.
struct BvhTriangle
{
  Vec3f a;
  Vec3f b;
  Vec3f c;
  std::int32_t target;
};

/// Slab test: whether the ray meets the box within [0, tMax].
SONO_HD inline bool meetsBox(const BvhNode& node, const Vec3f& position, const Vec3f& inverse, float tMax)
{
  float near = 0.0f;
  float far = tMax;
  for (int axis = 0; axis < 3; ++axis)
  {
    const float t0 = (node.low[axis] - position[axis]) * inverse[axis];
    const float t1 = (node.high[axis] - position[axis]) * inverse[axis];
    // fmin and fmax drop the NaN of 0 times infinity: a ray within a face of the box meets it.
    near = fmaxf(near, fminf(t0, t1));
    far = fminf(far, fmaxf(t0, t1));
  }
  // Rounding must not lose a triangle that lies in the box's face.
  return near <= far * 1.0000004f;
}

/// The same targets as EmbreeTargets for devices without Embree; trivially copyable. The edge tests are those of Woop
/// et al. 2013 ("Watertight ray/triangle intersection"): a ray through an edge meets one of its two triangles at least.
struct BvhTargets
{
  const BvhNode* nodes = nullptr;
  const BvhTriangle* triangles = nullptr;
  std::int32_t nodeCount = 0;

  SONO_HD bool any() const { return nodeCount > 0; }

  SONO_HD TargetHit nearest(const Vec3f& position, const Vec3f& direction, float tMax, bool inside) const
  {
    const Vec3f inverse(1.0f / direction.x, 1.0f / direction.y, 1.0f / direction.z);
    // The shear that turns the ray into the z axis.
    const Vec3f size = glm::abs(direction);
    const int kz = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const int kx = (kz + 1) % 3;
    const int ky = (kx + 1) % 3;
    const Vec3f shear(direction[kx] / direction[kz], direction[ky] / direction[kz], 1.0f / direction[kz]);

    TargetHit best{ tMax, Vec3f(0.0f), -1 };
    std::int32_t stack[64];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0)
    {
      const BvhNode& node = nodes[stack[--depth]];
      if (!meetsBox(node, position, inverse, best.t))
      {
        continue;
      }
      if (node.count == 0)
      {
        stack[depth++] = node.first;
        stack[depth++] = node.first + 1;
        continue;
      }
      for (std::int32_t i = node.first; i < node.first + node.count; ++i)
      {
        const BvhTriangle& triangle = triangles[i];
        const Vec3f a = triangle.a - position;
        const Vec3f b = triangle.b - position;
        const Vec3f c = triangle.c - position;
        const float ax = a[kx] - shear.x * a[kz];
        const float ay = a[ky] - shear.y * a[kz];
        const float bx = b[kx] - shear.x * b[kz];
        const float by = b[ky] - shear.y * b[kz];
        const float cx = c[kx] - shear.x * c[kz];
        const float cy = c[ky] - shear.y * c[kz];
        const float u = cx * by - cy * bx;
        const float v = ax * cy - ay * cx;
        const float w = bx * ay - by * ax;
        if ((u < 0.0f || v < 0.0f || w < 0.0f) && (u > 0.0f || v > 0.0f || w > 0.0f))
        {
          continue;
        }
        const float det = u + v + w;
        if (det == 0.0f)
        {
          continue;
        }
        const float t = (u * a[kz] + v * b[kz] + w * c[kz]) * shear.z / det;
        const Vec3f normal = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
        const float along = glm::dot(normal, direction);
        if (t >= 0.0f && t < best.t && (inside ? along > 0.0f : along < 0.0f))
        {
          best = { t, glm::normalize(normal), triangle.target };
        }
      }
    }
    return best;
  }
};

} // namespace sono
