#include "Labels/LabelWords.h"

#include "Core/EndsWith.h"
#include <cctype>
#include <cstddef>

namespace sono {

namespace {

enum class Kind
{
  Separator,
  Digit,
  Small,
  Capital
};

Kind kindOf(const std::string& text, std::size_t at)
{
  const auto letter = at < text.size() ? static_cast<unsigned char>(text[at]) : static_cast<unsigned char>(' ');
  if (std::isdigit(letter) != 0)
  {
    return Kind::Digit;
  }
  if (letter >= 'A' && letter <= 'Z')
  {
    return Kind::Capital;
  }
  return (letter >= 'a' && letter <= 'z') || letter >= 0x80 ? Kind::Small : Kind::Separator;
}

/// Whether a word ends before the character at `at`, of which the one before belongs to it.
bool endsBefore(const std::string& name, std::size_t at)
{
  const Kind before = kindOf(name, at - 1);
  const Kind here = kindOf(name, at);
  if (here == Kind::Separator || (before == Kind::Digit) != (here == Kind::Digit))
  {
    return true;
  }
  // A capital begins a word after a small letter, and after capitals where a small one follows it.
  return here == Kind::Capital && (before == Kind::Small || kindOf(name, at + 1) == Kind::Small);
}

} // namespace

std::string singular(std::string word)
{
  if (word.size() < 4)
  {
    return word;
  }
  if (endsWith(word, "ies"))
  {
    return word.replace(word.size() - 3, 3, "y");
  }
  for (const char* ending : { "ses", "xes", "ches", "shes" })
  {
    if (endsWith(word, ending))
    {
      return word.substr(0, word.size() - 2);
    }
  }
  if (endsWith(word, "ae"))
  {
    return word.substr(0, word.size() - 1);
  }
  const bool isPlural = endsWith(word, "s") && !endsWith(word, "ss") && !endsWith(word, "us") && !endsWith(word, "is");
  return isPlural ? word.substr(0, word.size() - 1) : word;
}

std::vector<std::string> wordsOfName(const std::string& name)
{
  std::vector<std::string> words;
  std::string word;
  for (std::size_t at = 0; at <= name.size(); ++at)
  {
    if (!word.empty() && endsBefore(name, at))
    {
      words.push_back(singular(word));
      word.clear();
    }
    if (kindOf(name, at) != Kind::Separator)
    {
      word += char(std::tolower(static_cast<unsigned char>(name[at])));
    }
  }
  return words;
}

} // namespace sono
