#pragma once

#include <cstddef>
#include <vector>

namespace sono {

/// Has all cores write to each page of memory that was just taken and holds nothing yet. Fresh memory costs a fault for
/// each page that is written to first, on one core more than to fill it: half a second a gigabyte, and several where a
/// virtual machine has to ask its host. Small memory is left as it is.
void touchMemory(void* memory, std::size_t bytes);

/// No numbers, with room for `count` that was touched.
template<class T>
std::vector<T> roomFor(std::size_t count)
{
  std::vector<T> numbers;
  numbers.reserve(count);
  touchMemory(numbers.data(), count * sizeof(T));
  return numbers;
}

/// `count` numbers, all 0, in memory that all cores touched.
template<class T>
std::vector<T> largeVector(std::size_t count)
{
  std::vector<T> numbers = roomFor<T>(count);
  numbers.resize(count);
  return numbers;
}

/// The same, all of a value.
template<class T>
std::vector<T> largeVector(std::size_t count, T value)
{
  std::vector<T> numbers = roomFor<T>(count);
  numbers.resize(count, value);
  return numbers;
}

} // namespace sono
