#include "Labels/AssignTissues.h"

#include "Core/Progress.h"
#include "Labels/CsvFile.h"
#include "Labels/LabelWords.h"

#include <algorithm>
#include <cstddef>

namespace sono {

std::vector<LabelTissueMap::Word> LabelTissueMap::wordsOfPattern(const std::string& pattern)
{
  std::vector<Word> words;
  for (std::size_t begin = 0; begin <= pattern.size();)
  {
    const std::size_t end = std::min(pattern.find('*', begin), pattern.size());
    const std::string part =
      pattern.substr(begin, end - begin); // "*ventric*wall*" is two words, each open at both ends
    std::vector<std::string> texts = wordsOfName(part);
    const std::size_t first = words.size();
    for (const std::string& text : texts)
    {
      words.push_back({ text, false, false });
    }
    if (!texts.empty())
    {
      const auto isLetter = [](char c) { return !wordsOfName(std::string(1, c)).empty(); };
      words[first].openBefore = begin > 0 && isLetter(part.front());
      words.back().openAfter = end < pattern.size() && isLetter(part.back());
    }
    begin = end + 1;
  }
  return words;
}

bool LabelTissueMap::matches(const Word& word, const std::string& text)
{
  if (word.openBefore && word.openAfter)
  {
    return text.find(word.text) != std::string::npos;
  }
  if (text.size() < word.text.size())
  {
    return false;
  }
  if (word.openAfter)
  {
    return text.compare(0, word.text.size(), word.text) == 0;
  }
  const std::size_t begin = text.size() - word.text.size();
  return (begin == 0 || word.openBefore) && text.compare(begin, word.text.size(), word.text) == 0;
}

LabelTissueMap LabelTissueMap::read(const std::string& path)
{
  const CsvFile csv = CsvFile::read(path);
  const auto pattern = std::size_t(csv.requiredColumn("pattern"));
  const auto tissue = std::size_t(csv.requiredColumn("tissue"));
  const int guess = csv.column("guess");
  const int code = csv.column("code");
  const auto field = [](const CsvFile::Row& row, int column) {
    return column < 0 ? std::string() : row.fields[std::size_t(column)];
  };
  LabelTissueMap map;
  for (const CsvFile::Row& row : csv.rows)
  {
    const LabelTissueRule rule{ row.fields[pattern], row.fields[tissue], field(row, guess) == "yes", field(row, code) };
    if ((rule.pattern.empty() && rule.code.empty()) || rule.tissue.empty())
    {
      throw Error(csv.where(row) + " lacks a pattern or a tissue; write both, or remove the line.");
    }
    if (!rule.guess && !field(row, guess).empty())
    {
      throw Error(csv.where(row) + " has '" + field(row, guess) + "' in column 'guess'; write yes, or nothing.");
    }
    map.add(rule);
  }
  return map;
}

void LabelTissueMap::add(const LabelTissueRule& rule)
{
  words_.push_back(wordsOfPattern(rule.pattern));
  rules_.push_back(rule);
}

const LabelTissueRule* LabelTissueMap::matchName(const std::string& name) const
{
  const std::vector<std::string> texts = wordsOfName(name);
  for (std::size_t n = 0; n < rules_.size(); ++n)
  {
    const bool isMatch =
      !rules_[n].pattern.empty() && std::all_of(words_[n].begin(), words_[n].end(), [&texts](const Word& word) {
        return std::any_of(texts.begin(), texts.end(),
                           [&word](const std::string& text) { return matches(word, text); });
      });
    if (isMatch)
    {
      return &rules_[n];
    }
  }
  return nullptr;
}

const LabelTissueRule* LabelTissueMap::matchCode(const std::string& code) const
{
  const auto at = std::find_if(rules_.begin(), rules_.end(),
                               [&code](const LabelTissueRule& rule) { return !code.empty() && rule.code == code; });
  return at == rules_.end() ? nullptr : &*at;
}

std::string LabelTissueMap::find(const std::string& name) const
{
  const LabelTissueRule* rule = matchName(name);
  return rule ? rule->tissue : std::string();
}

std::vector<std::string> assignTissues(LabelVolume& volume, const LabelTissueMap& map, const TissueTable& table,
                                       const std::string& fallback)
{
  if (!table.find(fallback))
  {
    throw Error("the tissue '" + fallback +
                "' for labels without a pattern is not in the tissue table; choose one of "
                "its tissues.");
  }
  std::vector<LabelInfo> labels = volume.labels; // so that an Error leaves the volume as it was
  std::vector<std::string> unmatched;
  for (LabelInfo& label : labels)
  {
    if (label.tissue.empty())
    {
      const LabelTissueRule* byCode = map.matchCode(label.code);
      const LabelTissueRule* byName = byCode ? byCode : map.matchName(label.name);
      // What is left over has many names ("Unknown", "black").
      const LabelTissueRule* rule = byName || label.id != 0 ? byName : map.matchName("background");
      label.tissue = rule ? rule->tissue : fallback;
      label.guessed = !rule || rule->guess;
      if (!rule)
      {
        unmatched.push_back(label.name);
      }
    }
    if (!table.find(label.tissue))
    {
      throw Error("the tissue '" + label.tissue + "' of label " + std::to_string(label.id) + " '" + label.name +
                  "' is not in the tissue table; add it there or choose another.");
    }
  }
  volume.labels = std::move(labels);
  return unmatched;
}

} // namespace sono
