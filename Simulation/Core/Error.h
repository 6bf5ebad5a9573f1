#pragma once

#include <exception>
#include <stdexcept>

namespace sono {

/// Bad input. The message is one sentence that names the file, label or parameter and the way out.
class Error : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Thrown when a Progress callback returned false. Not an error: nothing is wrong with the input.
class Aborted : public std::exception
{
public:
  const char* what() const noexcept override { return "stopped at the user's request"; }
};

} // namespace sono
