#pragma once

#include "Core/Parameters.h"
#include "DataSets/Draw.h"
#include "DataSets/StrictJson.h"

#include <string>
#include <type_traits>
#include <vector>

// Numbers, switches and choices of a data set's file, which may be drawn. What is not allowed is an Error that names
// file and key.

namespace sono {

/// What a number of the file may be.
struct Allowed
{
  Range range;
  bool whole = false;
  bool isSwitch = false;
  std::vector<const char*> choices = {}; ///< of an enumeration
};

template<class Value>
Allowed allowedOf(const Parameter& parameter)
{
  return { parameter.range, std::is_integral_v<Value> && !std::is_same_v<Value, bool>, std::is_same_v<Value, bool>,
           parameter.choices };
}

/// A value; of a choice its place among them, of a switch 0 or 1.
double readValue(StrictObject& object, const std::string& key, const Allowed& allowed);
/// The two ends of a range, under these names; `parent` and `key` are where it stands.
Draw readRange(StrictObject& range, const StrictObject& parent, const std::string& key, const char* from,
               const char* to, const Allowed& allowed);
/// A value, {"from": a, "to": b} or {"oneOf": [...]}.
Draw readDraw(StrictObject& object, const std::string& key, const Allowed& allowed);

} // namespace sono
