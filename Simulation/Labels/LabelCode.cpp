#include "Labels/LabelCode.h"

#include "Labels/LabelWords.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <vector>

namespace sono {

namespace {

std::vector<std::string> splitAt(const std::string& text, char separator)
{
  std::vector<std::string> parts(1);
  for (const char letter : text)
  {
    if (letter == separator)
    {
      parts.emplace_back();
    }
    else
    {
      parts.back() += letter;
    }
  }
  return parts;
}

CodedConcept conceptOf(const std::string& text)
{
  std::vector<std::string> parts = splitAt(text, '^');
  parts.resize(3);
  return { parts[0], parts[1], parts[2] };
}

std::string lowerCase(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

} // namespace

bool saysNothing(const std::string& name)
{
  const std::vector<std::string> words = wordsOfName(name);
  return std::all_of(words.begin(), words.end(), [](const std::string& word) {
    return std::isdigit(static_cast<unsigned char>(word[0])) != 0 || word == "segment" || word == "label" ||
           word == "mask" || word == "structure" || word == "tissue";
  });
}

void describeByCode(const CodedConcept& type, const CodedConcept& modifier, LabelInfo& label)
{
  if (type.value.empty())
  {
    return;
  }
  const bool isOld = type.scheme == "SNM3" || type.scheme == "99SDM";
  label.code = (isOld ? "SRT" : type.scheme) + " " + type.value;
  if (saysNothing(label.name) && !saysNothing(type.meaning))
  {
    label.name = lowerCase((modifier.meaning.empty() ? "" : modifier.meaning + " ") + type.meaning);
  }
}

void describeBySlicerTags(const std::string& tags, LabelInfo& label)
{
  const std::string key = "TerminologyEntry:";
  for (const std::string& tag : splitAt(tags, '|'))
  {
    if (tag.compare(0, key.size(), key) == 0)
    {
      std::vector<std::string> fields = splitAt(tag.substr(key.size()), '~');
      fields.resize(4);
      describeByCode(conceptOf(fields[2]), conceptOf(fields[3]), label);
    }
  }
}

} // namespace sono
