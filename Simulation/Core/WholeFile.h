#pragma once

#include <functional>
#include <iosfwd>
#include <string>

namespace sono {

/// Writes a file whole or not at all: beside it first, whose name no other process takes, then renamed. False where the
/// folder is missing or protected, or the disk is full; what was there before is then left.
bool writeWholeFile(const std::string& path, const std::function<void(std::ostream&)>& write);

} // namespace sono
