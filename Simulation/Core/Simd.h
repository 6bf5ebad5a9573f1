#pragma once

/// Compiles a hot host loop for several instruction sets; the machine picks one when the program starts. The
/// distribution's baseline is SSE2, a quarter of what these loops can use. Not under the sanitizers: the choice is made
/// before their runtime is there, which the function that chooses would call.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) &&               \
  !defined(__SANITIZE_THREAD__)
#define SONO_SIMD_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define SONO_SIMD_CLONES
#endif

namespace sono {

/// Single-precision numbers in the widest vector. A loop over a multiple of so many has no rest to go through one by
/// one, which would take most of the time of a short one.
constexpr int vectorWidth = 16;

/// The next such multiple.
constexpr int inWholeVectors(int count)
{
  return (count + vectorWidth - 1) / vectorWidth * vectorWidth;
}

} // namespace sono
