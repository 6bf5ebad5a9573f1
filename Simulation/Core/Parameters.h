#pragma once

#include "Core/Error.h"

#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

// A settings struct says all about each of its parameters in one place: in its member function
//
//   template<class Self, class Visitor> static void visit(Self& self, Visitor&& visitor)
//   {
//     visitor(self.pathsPerLine, Parameter{ "pathsPerLine", "Paths per Line", between(1, 1e7), "Paths per ..." });
//     ...
//   }
//
// where the default is the member's own initialiser. Range checks, the filters' Set and Get, PrintSelf, ParaView's
// properties and the tests walk over it.

namespace sono {

/// The values that a parameter may have. NaN is in none.
struct Range
{
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool withLow = true;
  bool withHigh = true;

  bool contains(double value) const
  {
    return (withLow ? value >= low : value > low) && (withHigh ? value <= high : value < high);
  }

  std::string text() const
  {
    const auto isFinite = [](double bound) { return bound - bound == 0.0; };
    std::ostringstream words;
    words.precision(10);
    if (isFinite(low) && isFinite(high) && withLow && withHigh)
    {
      words << "between " << low << " and " << high;
      return words.str();
    }
    if (isFinite(low))
    {
      words << (withLow ? "at least " : "more than ") << low;
    }
    if (isFinite(high))
    {
      words << (isFinite(low) ? " and " : "") << (withHigh ? "at most " : "less than ") << high;
    }
    return words.str();
  }
};

inline Range between(double low, double high)
{
  return { low, high, true, true };
}
inline Range atLeast(double low)
{
  return { low, std::numeric_limits<double>::infinity(), true, false };
}
inline Range above(double low)
{
  return { low, std::numeric_limits<double>::infinity(), false, false };
}
/// Without its lower end.
inline Range aboveUpTo(double low, double high)
{
  return { low, high, false, true };
}
/// Without its ends.
inline Range inside(double low, double high)
{
  return { low, high, false, false };
}
/// Minus infinity is allowed.
inline Range atMost(double high)
{
  return { -std::numeric_limits<double>::infinity(), high, true, true };
}

/// What there is to say about a parameter besides its type and its default, which the member has.
struct Parameter
{
  const char* name;                      ///< the unit at its end; that of properties and methods, but for its capital
  const char* label;                     ///< in a panel, with the unit in parentheses
  Range range;                           ///< of a number; not of a switch or a choice
  const char* sentence;                  ///< what it is, with unit and range: the tooltip
  std::vector<const char*> choices = {}; ///< of an enumeration, from value 0 on
};

/// The name of the property and of the methods Set... and Get...: PathsPerLine.
inline std::string propertyName(const Parameter& parameter)
{
  std::string name = parameter.name;
  name[0] = char(name[0] - 'a' + 'A');
  return name;
}

/// A member as a number, as properties have it, and back.
template<class Value>
double numberOf(Value value)
{
  if constexpr (std::is_same_v<Value, std::uint64_t>)
  {
    return double(std::int64_t(value));
  }
  else
  {
    return double(value);
  }
}
template<class Value>
Value valueOf(double number)
{
  if constexpr (std::is_same_v<Value, bool>)
  {
    return number != 0.0;
  }
  else if constexpr (std::is_same_v<Value, double>)
  {
    return number;
  }
  else
  {
    return static_cast<Value>(std::int64_t(number));
  }
}

/// Throws Error naming the parameter, its value and its range when it lies outside.
template<class Value>
void requireInRange(Value value, const Parameter& parameter)
{
  const double number = numberOf(value);
  std::string range;
  if (!parameter.choices.empty())
  {
    if (number >= 0.0 && number < double(parameter.choices.size()))
    {
      return;
    }
    for (std::size_t i = 0; i < parameter.choices.size(); ++i)
    {
      range += (i == 0                             ? ""
                : i + 1 < parameter.choices.size() ? ", "
                                                   : " or ") +
               std::to_string(i) + " (" + parameter.choices[i] + ")";
    }
  }
  else if (std::is_same_v<Value, bool> || parameter.range.contains(number))
  {
    return;
  }
  else
  {
    range = parameter.range.text();
  }
  std::ostringstream sentence;
  sentence << parameter.name << " is " << number << ": it must be " << range;
  throw Error(sentence.str());
}

/// The same for all parameters of some settings.
template<class Settings>
void requireInRange(const Settings& settings)
{
  Settings::visit(settings, [](const auto& value, const Parameter& parameter) { requireInRange(value, parameter); });
}

} // namespace sono
