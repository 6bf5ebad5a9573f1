#pragma once

#include "Core/Progress.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace sono::testing {

/// The message of the Error that `action` throws; "no error" when it throws none.
inline std::string errorOf(const std::function<void()>& action)
{
  try
  {
    action();
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "no error";
}

inline void expectContains(const std::string& text, const std::string& part)
{
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is missing in: " << text;
}

} // namespace sono::testing
