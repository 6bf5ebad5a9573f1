#pragma once

#include "Kernel/HostDevice.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace sono {

using Vec2f = glm::vec2;
using Vec2d = glm::dvec2;
using Vec3f = glm::vec3;
using Vec3d = glm::dvec3;
using Vec3i = glm::ivec3;
using Mat3d = glm::dmat3; ///< column-major: m[c] is column c

} // namespace sono
