#pragma once

#include "Core/Hash64.h"

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace sono {

/// Writes down, to the last bit, what a result depends on, so that two texts are equal where the results are.
class KeyText
{
public:
  KeyText& add(std::string_view words)
  {
    text_ += std::to_string(words.size()) + ':';
    text_ += words;
    return *this;
  }
  KeyText& add(const char* words) { return add(std::string_view(words)); }
  KeyText& add(double number)
  {
    char digits[40];
    std::snprintf(digits, sizeof(digits), "%a;", number);
    text_ += digits;
    return *this;
  }
  KeyText& addHash(std::uint64_t hash)
  {
    text_ += hashDigits(hash) + ';';
    return *this;
  }
  const std::string& text() const { return text_; }

private:
  std::string text_;
};

} // namespace sono
