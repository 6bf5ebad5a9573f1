#pragma once

#include "Core/Error.h"
#include "Core/ParallelFor.h"
#include "Core/Progress.h"
#include "Core/Simd.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vector_relational.hpp>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <complex>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

// The kernels' own source with every float a double, under another name, so that both can be linked. The numbers that
// decide, labels, records and random words, are the same. What includes this may name no type of `sono` whose header
// holds a float.

namespace sonoInDouble {
using ::sono::Error;
using ::sono::parallelFor;
using ::sono::partOf;
using ::sono::Progress;
using ::sono::YieldPoint;
} // namespace sonoInDouble

#define float double
#define vec2 dvec2
#define vec3 dvec3
#define sono sonoInDouble
#define atan2f atan2
#define ceilf ceil
#define cosf cos
#define erfcf erfc
#define expf exp
#define fabsf fabs
#define floorf floor
#define fmaxf fmax
#define fminf fmin
#define logf log
#define powf pow
#define sinf sin
#define sqrtf sqrt

// Polynomials that are single precision by construction make room for the library's functions.
#define cosSmall cosSmallOfFloat
#define expNegative expNegativeOfFloat
#define logPositive logPositiveOfFloat
#define sinSmall sinSmallOfFloat
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wstringop-overread"
#pragma GCC diagnostic ignored "-Warray-bounds"
#include "Kernel/FastMath.h"
#pragma GCC diagnostic pop
#undef cosSmall
#undef expNegative
#undef logPositive
#undef sinSmall

namespace sonoInDouble {
inline double cosSmall(double x)
{
  return std::cos(x);
}
inline double expNegative(double x)
{
  return std::exp(x);
}
inline double logPositive(double x)
{
  return std::log(x);
}
inline double sinSmall(double x)
{
  return std::sin(x);
}
} // namespace sonoInDouble

#include "Core/SoundSpeed.h"
#include "Kernel/BeamDeposit.h"
#include "Kernel/EchoSplat.h"
#include "Kernel/Scatterer.h"
#include "Kernel/TargetBvh.h"
#include "Kernel/TimeOfFlight.h"
#include "Kernel/TracePath.h"
#include "Trace/Deposit.h"
#include "Trace/Trace.h"

#undef float
#undef vec2
#undef vec3
#undef sono
#undef atan2f
#undef ceilf
#undef cosf
#undef erfcf
#undef expf
#undef fabsf
#undef floorf
#undef fmaxf
#undef fminf
#undef logf
#undef powf
#undef sinf
#undef sqrtf
