#pragma once

#include <string>
#include <vector>

class vtkFieldData;

namespace sono {

/// Arrays of numbers or strings as bytes, to be kept.
std::string packedArrays(vtkFieldData* arrays);

/// Adds what packedArrays has packed; arrays of a class of their own become ordinary ones. False for other bytes.
bool addPackedArrays(const std::string& bytes, vtkFieldData* arrays);

/// The same for sentences.
std::string packedSentences(const std::vector<std::string>& sentences);
std::vector<std::string> unpackedSentences(const std::string& bytes);

} // namespace sono
