#pragma once

#include "Labels/LabelVolume.h"
#include "Labels/TissueTable.h"

#include <string>
#include <vector>

namespace sono {

/// Which tissue a label is, by the words of its name or by its code.
struct LabelTissueRule
{
  std::string pattern; ///< words of a name; empty where the rule is for a code alone
  std::string tissue;
  bool guess = false; ///< what it says is likely, not sure
  std::string code{}; ///< as LabelInfo::code; empty where the rule is for names alone
};

/// Rules in order, of which the first that matches wins. A rule matches a name when each word of its pattern is among
/// the name's words (LabelWords.h), in whatever order and whatever else the name says; `*` at the beginning or the end
/// of a pattern's word stands for any letters there. A code matches as a whole.
class LabelTissueMap
{
public:
  /// CSV with the columns pattern, tissue and perhaps guess ("yes" or nothing) and code; lines starting with '#' are
  /// comments. Throws Error naming the file and line.
  static LabelTissueMap read(const std::string& path);

  void add(const LabelTissueRule& rule);
  /// nullptr when no rule matches.
  const LabelTissueRule* matchName(const std::string& name) const;
  const LabelTissueRule* matchCode(const std::string& code) const;
  /// The tissue of a name; empty when no rule matches.
  std::string find(const std::string& name) const;
  const std::vector<LabelTissueRule>& rules() const { return rules_; }

private:
  struct Word
  {
    std::string text;
    bool openBefore = false;
    bool openAfter = false;
  };
  static std::vector<Word> wordsOfPattern(const std::string& pattern);
  static bool matches(const Word& word, const std::string& text);

  std::vector<LabelTissueRule> rules_;
  std::vector<std::vector<Word>> words_; ///< of each rule
};

/// Fills LabelInfo::tissue where it is empty: by the label's code where a rule knows it, else by its name; label 0 that
/// neither tells is the background. Another label that no rule matches becomes `fallback`; the names of these are
/// returned. Sets LabelInfo::guessed for them, and for those that a rule only guesses. Throws Error when a tissue (of
/// the map, a label or the fallback) is not in the table, naming the label and the tissue.
std::vector<std::string> assignTissues(LabelVolume& volume, const LabelTissueMap& map, const TissueTable& table,
                                       const std::string& fallback);

} // namespace sono
