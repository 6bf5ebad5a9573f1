#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace sono {

/// The most that a cache folder holds, bytes, before what was not used for longest goes.
constexpr std::uint64_t cacheFolderBytes = std::uint64_t(4) << 30;

/// The user's own cache folder: $XDG_CACHE_HOME/sonovdb, else ~/.cache/sonovdb; empty where neither is known.
std::string userCacheFolder();

/// What was computed earlier, as files of a cache folder: `<kind>_<16 digits>.kept`, some strings of bytes each, and
/// beside them the scenes of makeCachedScene. A file may be deleted at any time; a damaged, foreign or newer one counts
/// as none.
///
/// `key` says all that the result depends on (KeyText). It is kept in the file and compared as a whole.
std::optional<std::vector<std::string>> findKept(const std::string& folder, const std::string& kind,
                                                 const std::string& key);

/// Keeps `parts`; the file appears whole or not at all. Where the folder cannot be made or written to, nothing is kept.
void keep(const std::string& folder, const std::string& kind, const std::string& key,
          const std::vector<std::string>& parts);

/// Marks a file of a cache folder as used now.
void markUsed(const std::string& path);

/// Removes files of ours from the folder, those first that were not used for longest, until no more than `bytes` are
/// left; but never the last one that was used, unless `bytes` is 0: then all of them.
void trimCacheFolder(const std::string& folder, std::uint64_t bytes = cacheFolderBytes);

} // namespace sono
