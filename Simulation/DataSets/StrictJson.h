#pragma once

#include "Core/Parameters.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace sono {

/// An object of a JSON file whose keys are taken one by one; what is left at the end is a mistake. Every complaint is
/// one sentence that names the file and the key.
class StrictObject
{
public:
  using Json = nlohmann::json;

  StrictObject(std::string file, std::string where, const Json& json)
    : file_(std::move(file))
    , where_(std::move(where))
    , json_(json)
  {
    if (!json.is_object())
    {
      throw Error("'" + file_ + "': " + (where_.empty() ? "the file" : "'" + where_ + "'") +
                  " is not an object; write one in braces.");
    }
  }

  bool has(const std::string& key)
  {
    known_.insert(key);
    return json_.contains(key);
  }

  const Json& take(const std::string& key)
  {
    if (!has(key))
    {
      throw Error("'" + file_ + "' lacks '" + fullName(key) + "'; add it.");
    }
    return json_[key];
  }

  std::string text(const std::string& key)
  {
    const Json& value = take(key);
    require(key, value.is_string() && !value.get<std::string>().empty(), "is not a text; write one in quotes");
    return value.get<std::string>();
  }
  std::string textOr(const std::string& key, const std::string& otherwise) { return has(key) ? text(key) : otherwise; }

  double number(const std::string& key, const Range& range)
  {
    const Json& value = take(key);
    require(key, value.is_number(), "is not a number; write one " + range.text());
    require(key, range.contains(value.get<double>()), "is out of range; write a number " + range.text());
    return value.get<double>();
  }
  double numberOr(const std::string& key, const Range& range, double otherwise)
  {
    return has(key) ? number(key, range) : otherwise;
  }

  /// `high` at most 2^53, up to which JSON's numbers are exact.
  std::int64_t whole(const std::string& key, double low, double high)
  {
    const double value = number(key, between(low, high));
    require(key, value == std::floor(value), "is not a whole number; write one " + between(low, high).text());
    return std::int64_t(value);
  }

  StrictObject object(const std::string& key) { return { file_, fullName(key), take(key) }; }

  /// An array of at least one object.
  std::vector<StrictObject> objects(const std::string& key)
  {
    const Json& array = take(key);
    require(key, array.is_array() && !array.empty(), "is not a list of objects; write at least one in brackets");
    std::vector<StrictObject> all;
    for (std::size_t i = 0; i < array.size(); ++i)
    {
      all.emplace_back(file_, fullName(key) + "[" + std::to_string(i) + "]", array[i]);
    }
    return all;
  }

  std::vector<std::string> texts(const std::string& key)
  {
    const Json& array = take(key);
    require(key, array.is_array() && !array.empty(), "is not a list of texts; write at least one in brackets");
    std::vector<std::string> all;
    for (const Json& value : array)
    {
      require(key, value.is_string() && !value.get<std::string>().empty(),
              "holds something that is not a text; write each in quotes");
      all.push_back(value.get<std::string>());
    }
    return all;
  }

  std::vector<std::string> keys()
  {
    std::vector<std::string> all;
    for (const auto& entry : json_.items())
    {
      all.push_back(entry.key());
      known_.insert(entry.key());
    }
    return all;
  }

  [[noreturn]] void fail(const std::string& key, const std::string& complaint) const
  {
    throw Error("'" + file_ + "': '" + fullName(key) + "' " + complaint + ".");
  }
  void require(const std::string& key, bool isRight, const std::string& complaint) const
  {
    if (!isRight)
    {
      fail(key, complaint);
    }
  }

  /// Throws Error for the first key that was not asked for.
  void refuseOthers() const
  {
    for (const auto& entry : json_.items())
    {
      if (known_.count(entry.key()) == 0)
      {
        std::string names;
        for (const std::string& name : known_)
        {
          names += (names.empty() ? "" : ", ") + name;
        }
        fail(entry.key(), "means nothing; remove or correct it (known here: " + names + ")");
      }
    }
  }

  const std::string& file() const { return file_; }

private:
  std::string fullName(const std::string& key) const { return where_.empty() ? key : where_ + "." + key; }

  std::string file_;
  std::string where_;
  const Json& json_;
  std::set<std::string> known_;
};

} // namespace sono
