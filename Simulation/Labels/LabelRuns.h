#pragma once

#include <cstddef>
#include <type_traits>

namespace sono {

/// Whether `count` numbers are all `value`; without a branch, so that the loop is vectors'.
template<std::size_t count, class T>
bool areAll(const T* numbers, T value)
{
  if constexpr (std::is_integral_v<T>)
  {
    T differing = 0;
    for (std::size_t n = 0; n < count; ++n)
    {
      differing = T(differing | (numbers[n] ^ value));
    }
    return differing == 0;
  }
  else
  {
    bool differs = false;
    for (std::size_t n = 0; n < count; ++n)
    {
      differs |= numbers[n] != value;
    }
    return !differs;
  }
}

/// Index of the first number from `n` on that differs from `value`; `count` if none does.
template<class T>
std::size_t firstOther(const T* numbers, std::size_t n, std::size_t count, T value)
{
  constexpr std::size_t many = 256;
  constexpr std::size_t some = 32;
  while (n + many <= count && areAll<many>(numbers + n, value))
  {
    n += many;
  }
  while (n + some <= count && areAll<some>(numbers + n, value))
  {
    n += some;
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
