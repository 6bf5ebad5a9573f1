#pragma once

#include <cstddef>

namespace sono {

/// Index of the first number from `n` on that differs from `value`; `count` if none does.
template<class T>
std::size_t firstOther(const T* numbers, std::size_t n, std::size_t count, T value)
{
  constexpr std::size_t block = 64; // compared at once, with vectors
  for (; n + block <= count; n += block)
  {
    bool other = false;
    for (std::size_t k = 0; k < block; ++k)
    {
      other |= numbers[n + k] != value;
    }
    if (other)
    {
      break;
    }
  }
  while (n < count && numbers[n] == value)
  {
    ++n;
  }
  return n;
}

/// Calls visit(begin, end, value) for the runs of equal numbers, one after the other: a label map has few.
template<class T, class Visit>
void forRuns(const T* numbers, std::size_t count, const Visit& visit)
{
  for (std::size_t begin = 0; begin < count;)
  {
    const std::size_t end = firstOther(numbers, begin, count, numbers[begin]);
    visit(begin, end, numbers[begin]);
    begin = end;
  }
}

} // namespace sono
