#pragma once

#include <string>
#include <vector>

namespace sono {

/// The words of a label's name, in lower case: runs of letters and runs of digits. Everything else separates them, and
/// so does a capital inside a word ("leftRib6", "CTLiver"). A simple plural becomes the singular ("ribs", "arteries",
/// "vertebrae", "sinuses"), so that words of a name and of a rule may be compared as they stand. Bytes beyond ASCII
/// count as small letters.
std::vector<std::string> wordsOfName(const std::string& name);

/// The singular of a word in lower case, by its ending alone: "pancreas" loses its s too. Words of up to three letters
/// stay.
std::string singular(std::string word);

} // namespace sono
