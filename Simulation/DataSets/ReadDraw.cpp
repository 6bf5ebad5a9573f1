#include "DataSets/ReadDraw.h"

#include <cmath>
#include <string>

namespace sono {

namespace {

using Json = StrictObject::Json;

double valueOf(const StrictObject& object, const std::string& key, const Json& value, const Allowed& allowed)
{
  if (allowed.isSwitch)
  {
    object.require(key, value.is_boolean(), "is no switch; write true or false");
    return value.get<bool>() ? 1.0 : 0.0;
  }
  if (!allowed.choices.empty())
  {
    std::string names;
    for (std::size_t i = 0; i < allowed.choices.size(); ++i)
    {
      if (value.is_string() && value.get<std::string>() == allowed.choices[i])
      {
        return double(i);
      }
      names += (i == 0 ? "\"" : ", \"") + std::string(allowed.choices[i]) + "\"";
    }
    object.fail(key, "is no such choice; write one of " + names);
  }
  const std::string kind = allowed.whole ? "a whole number " : "a number ";
  object.require(key, value.is_number(), "is not a number; write " + kind + allowed.range.text());
  const double number = value.get<double>();
  object.require(key, allowed.range.contains(number) && (!allowed.whole || number == std::floor(number)),
                 "is out of range; write " + kind + allowed.range.text());
  return number;
}

} // namespace

double readValue(StrictObject& object, const std::string& key, const Allowed& allowed)
{
  return valueOf(object, key, object.take(key), allowed);
}

Draw readRange(StrictObject& range, const StrictObject& parent, const std::string& key, const char* from,
               const char* to, const Allowed& allowed)
{
  Draw draw{ Draw::Kind::Uniform, {}, allowed.whole };
  for (const char* end : { from, to })
  {
    draw.values.push_back(readValue(range, end, allowed));
  }
  range.refuseOthers();
  parent.require(key, draw.values[0] <= draw.values[1],
                 std::string("is a range upside down; exchange '") + from + "' and '" + to + "'");
  return draw;
}

Draw readDraw(StrictObject& object, const std::string& key, const Allowed& allowed)
{
  const Json& value = object.take(key);
  if (!value.is_object())
  {
    return always(valueOf(object, key, value, allowed));
  }
  StrictObject drawn = object.object(key);
  if (drawn.has("oneOf"))
  {
    const Json& list = drawn.take("oneOf");
    drawn.require("oneOf", list.is_array() && !list.empty(), "is not a list; write at least one value in brackets");
    Draw draw{ Draw::Kind::OneOf, {}, false };
    for (const Json& one : list)
    {
      draw.values.push_back(valueOf(drawn, "oneOf", one, allowed));
    }
    drawn.refuseOthers();
    return draw;
  }
  object.require(key, !allowed.isSwitch && allowed.choices.empty(),
                 "has no range; write a value or {\"oneOf\": [...]}");
  return readRange(drawn, object, key, "from", "to", allowed);
}

} // namespace sono
