#pragma once

#include "Scene/SurfaceField.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sono {

/// A NanoVDB file (.nvdb) with a text of ours in it, written and read under the format's own rules, so that other
/// programs see its grids. The text is the blind data "sonovdb" of the first grid: eight bytes hash64 of the text, then
/// the text: one line of fingerprints, hash64 of each grid's tree in hexadecimal; one line from who wrote the file; and
/// perhaps bytes.
struct NanoFile
{
  std::vector<NanoGrid> grids;
  std::vector<std::string> names; ///< parallel to `grids`
  std::string text;
  std::vector<std::uint8_t> bytes; ///< what was written behind the text; empty: nothing
};

/// Throws Error naming the file when it cannot be written. The file appears whole or not at all.
void writeNanoFile(const std::string& path, const std::vector<const NanoGrid*>& grids, const std::string& text,
                   const std::vector<std::uint8_t>& bytes = {});

/// Throws Error naming the file when it is missing, foreign, of another major version of NanoVDB, compressed,
/// truncated or damaged.
NanoFile readNanoFile(const std::string& path);

} // namespace sono
