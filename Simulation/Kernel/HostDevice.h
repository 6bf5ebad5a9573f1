#pragma once

/// Marks a function that g++ compiles for the CPU and nvcc for the CPU and the GPU, from one source.
#if defined(__CUDACC__)
#define SONO_HD __host__ __device__
#else
#define SONO_HD
#endif
