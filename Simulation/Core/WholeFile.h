#pragma once

#include <fstream>
#include <functional>
#include <iosfwd>
#include <string>

namespace sono {

/// A file that appears whole or not at all: its bytes go beside it, under a name that no other process takes, which
/// `finish` changes. Without that, or where the process is killed, what was there before is left.
class WholeFile
{
public:
  explicit WholeFile(const std::string& path);
  ~WholeFile();

  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// Bad where the folder is missing or protected, or the disk is full.
  std::ostream& stream() { return stream_; }
  /// Where the bytes are until then, for libraries that write files of their own.
  const std::string& partPath() const { return part_; }
  /// Gives the file its name. False where the stream is bad or the name cannot be given.
  bool finish();

private:
  std::string path_;
  std::string part_;
  std::ofstream stream_;
  bool isWhole_ = false; ///< and has its name
};

/// The same where all bytes are at hand.
bool writeWholeFile(const std::string& path, const std::function<void(std::ostream&)>& write);

} // namespace sono
