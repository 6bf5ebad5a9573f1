#pragma once

#include "Core/Progress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace sono {

/// The message must name the parameter.
inline void expectError(const std::function<void()>& call, const std::string& parameter)
{
  try
  {
    call();
    ADD_FAILURE() << "no error for " << parameter;
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find(parameter), std::string::npos) << error.what();
  }
}

/// Fully developed speckle of unit scale.
inline std::vector<float> rayleighEnvelope(std::size_t count, unsigned seed)
{
  std::mt19937 random(seed);
  std::vector<float> envelope(count);
  for (float& value : envelope)
  {
    value = std::sqrt(-2.0f * std::log(1.0f - std::generate_canonical<float, 24>(random)));
  }
  return envelope;
}

} // namespace sono
