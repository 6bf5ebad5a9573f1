#pragma once

#include "Cuda/DeviceImager.h"

#include <gtest/gtest.h>

/// Skips a test where there is no GPU, with the reason.
#define SONO_GPU_OR_SKIP()                                                                                             \
  do                                                                                                                   \
  {                                                                                                                    \
    const sono::DeviceStatus status = sono::cudaStatus();                                                              \
    if (!status.usable)                                                                                                \
    {                                                                                                                  \
      GTEST_SKIP() << status.what;                                                                                     \
    }                                                                                                                  \
  }                                                                                                                    \
  while (false)
