#include "Core/FileContent.h"

#include "Core/Error.h"
#include "Core/Hash64.h"
#include "Core/ParallelFor.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <sstream>
#include <vector>

namespace sono {

namespace {

/// An open file; -1: none.
struct OpenFile
{
  int descriptor;

  explicit OpenFile(const std::string& path)
    : descriptor(open(path.c_str(), O_RDONLY | O_CLOEXEC))
  {
  }
  ~OpenFile()
  {
    if (descriptor >= 0)
    {
      close(descriptor);
    }
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
};

} // namespace

std::string fileStamp(const std::string& path)
{
  struct stat s
  {
  };
  if (stat(path.c_str(), &s) != 0)
  {
    return {};
  }
  std::ostringstream text;
  text << s.st_dev << ' ' << s.st_ino << ' ' << s.st_size << ' ' << s.st_mtim.tv_sec << '.' << s.st_mtim.tv_nsec << ' '
       << s.st_ctim.tv_sec << '.' << s.st_ctim.tv_nsec;
  return text.str();
}

std::uint64_t fileHash(const std::string& path)
{
  constexpr std::size_t together = std::size_t(1) << 21;
  const OpenFile file(path);
  struct stat s
  {
  };
  const std::string cannot = "cannot read '" + path + "': no such file, or no permission to read it.";
  if (file.descriptor < 0 || fstat(file.descriptor, &s) != 0 || !S_ISREG(s.st_mode))
  {
    throw Error(cannot);
  }
  const std::size_t bytes = std::size_t(s.st_size);
  std::vector<std::uint64_t> parts((bytes + together - 1) / together);
  parallelFor(int(parts.size()), {}, [&](int part) {
    const std::size_t first = std::size_t(part) * together;
    const std::size_t count = std::min(together, bytes - first);
    std::vector<char> buffer(count);
    std::size_t done = 0;
    while (done < count)
    {
      const ssize_t got = pread(file.descriptor, buffer.data() + done, count - done, off_t(first + done));
      if (got <= 0)
      {
        throw Error(cannot);
      }
      done += std::size_t(got);
    }
    parts[std::size_t(part)] = hash64(buffer.data(), count);
  });
  return hash64(parts.data(), parts.size() * sizeof(parts[0]), bytes);
}

} // namespace sono
