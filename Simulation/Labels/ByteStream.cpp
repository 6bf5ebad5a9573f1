#include "Labels/ByteStream.h"

#include "Core/Error.h"

#include <isa-l/igzip_lib.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstring>

namespace sono {

namespace {

constexpr std::size_t bufferBytes = std::size_t(1) << 18;
constexpr char firstOfGzip = '\x1f';

struct CloseFile
{
  void operator()(std::FILE* file) const { std::fclose(file); }
};

} // namespace

struct ByteStream::Impl
{
  std::string name;
  std::unique_ptr<std::FILE, CloseFile> file; // none: all bytes are in `buffer`
  std::uint64_t start = 0;
  std::uint64_t fileBytes = 0; // from `start` on
  std::uint64_t given = 0;     // of those, read from the file
  std::vector<char> buffer;
  std::size_t at = 0;  // the first byte of the buffer that nobody took
  std::size_t end = 0; // and the end of what is in it
  Packing packing = Packing::None;
  std::unique_ptr<inflate_state> inflater; // 64 kB of its own
  bool ended = false;                      // the compressed stream
  bool begun = false;

  [[noreturn]] void truncated() const
  {
    throw Error("cannot read '" + name + "': its voxel data end too early or are damaged; copy it again.");
  }

  /// Whether the buffer holds a byte that nobody took.
  bool fill()
  {
    if (at == end && file)
    {
      end = std::fread(buffer.data(), 1, buffer.size(), file.get());
      at = 0;
      given += end;
    }
    return at < end;
  }

  void copy(char* to, std::size_t bytes)
  {
    while (bytes > 0)
    {
      if (!fill())
      {
        truncated();
      }
      const std::size_t part = std::min(bytes, end - at);
      std::memcpy(to, buffer.data() + at, part);
      at += part;
      to += part;
      bytes -= part;
    }
  }

  /// Of zlib or gzip, as the next byte says.
  bool beginMember()
  {
    if (!fill())
    {
      return false;
    }
    const bool isGzip = buffer[at] == firstOfGzip;
    isal_inflate_init(inflater.get());
    inflater->crc_flag = isGzip ? ISAL_GZIP : ISAL_ZLIB;
    ended = false;
    return true;
  }

  /// Another gzip member may follow the one that ended.
  bool nextMember() { return fill() && buffer[at] == firstOfGzip && beginMember(); }

  /// At most `bytes`; fewer only where the stream ends.
  std::size_t inflateSome(char* to, std::size_t bytes)
  {
    begun = begun || beginMember();
    if (!begun)
    {
      truncated();
    }
    std::size_t done = 0;
    while (done < bytes && (!ended || nextMember()))
    {
      const bool hasInput = fill();
      constexpr std::size_t most = std::size_t(1) << 30; // ISA-L counts in 32 bits
      const std::uint32_t room = std::uint32_t(std::min(most, bytes - done));
      inflater->next_in = reinterpret_cast<std::uint8_t*>(buffer.data() + at);
      inflater->avail_in = std::uint32_t(end - at);
      inflater->next_out = reinterpret_cast<std::uint8_t*>(to + done);
      inflater->avail_out = room;
      const int status = isal_inflate(inflater.get());
      at = end - inflater->avail_in;
      done += room - inflater->avail_out;
      ended = inflater->block_state == ISAL_BLOCK_FINISH;
      const bool stuck = !hasInput && !ended && inflater->avail_out == room;
      if (status != ISAL_DECOMP_OK || stuck)
      {
        truncated();
      }
    }
    return done;
  }
};

ByteStream::ByteStream(const std::string& path, std::uint64_t start, Packing packing, std::string name)
  : ByteStream(std::fopen(path.c_str(), "rb"), packing, std::move(name))
{
  if (start > impl_->fileBytes || fseeko(impl_->file.get(), off_t(start), SEEK_SET) != 0)
  {
    impl_->truncated();
  }
  impl_->start = start;
  impl_->fileBytes -= start;
}

ByteStream::ByteStream(std::FILE* file, Packing packing, std::string name)
  : impl_(std::make_unique<Impl>())
{
  impl_->name = std::move(name);
  impl_->packing = packing;
  impl_->file.reset(file);
  struct stat status
  {
  };
  const off_t start = file ? ftello(file) : -1;
  if (start < 0 || fstat(fileno(file), &status) != 0 || !S_ISREG(status.st_mode) || start > status.st_size)
  {
    impl_->truncated();
  }
  impl_->start = std::uint64_t(start);
  impl_->fileBytes = std::uint64_t(status.st_size - start);
  impl_->buffer.resize(std::size_t(std::clamp<std::uint64_t>(impl_->fileBytes, 1, bufferBytes)));
  if (packing == Packing::Deflate)
  {
    // ISA-L: three to five times as fast as zlib on label maps, and as libdeflate would be if it could stream.
    impl_->inflater = std::make_unique<inflate_state>();
  }
}

ByteStream::ByteStream(std::vector<char> bytes, std::string name)
  : impl_(std::make_unique<Impl>())
{
  impl_->name = std::move(name);
  impl_->buffer = std::move(bytes);
  impl_->end = impl_->buffer.size();
  impl_->fileBytes = impl_->given = impl_->end;
}

ByteStream::~ByteStream() = default;
ByteStream::ByteStream(ByteStream&&) noexcept = default;
ByteStream& ByteStream::operator=(ByteStream&&) noexcept = default;

void ByteStream::need(std::uint64_t bytes) const
{
  const std::uint64_t left = impl_->fileBytes - impl_->given + (impl_->end - impl_->at);
  const bool deflated = impl_->packing == Packing::Deflate;
  if (deflated ? bytes / largestInflation > left : bytes > left)
  {
    impl_->truncated();
  }
}

void ByteStream::read(void* to, std::size_t bytes)
{
  char* const target = static_cast<char*>(to);
  if (impl_->packing == Packing::None)
  {
    impl_->copy(target, bytes);
  }
  else if (impl_->inflateSome(target, bytes) != bytes)
  {
    impl_->truncated();
  }
}

void ByteStream::skip(std::uint64_t bytes)
{
  need(bytes);
  std::vector<char> dropped(std::size_t(std::min<std::uint64_t>(bytes, bufferBytes)));
  if (impl_->packing == Packing::None && impl_->file)
  {
    const std::uint64_t position = impl_->start + impl_->given - (impl_->end - impl_->at) + bytes;
    impl_->given = position - impl_->start;
    impl_->at = impl_->end = 0;
    if (fseeko(impl_->file.get(), off_t(position), SEEK_SET) != 0)
    {
      impl_->truncated();
    }
    return;
  }
  for (; bytes > 0; bytes -= std::min<std::uint64_t>(bytes, bufferBytes))
  {
    read(dropped.data(), std::size_t(std::min<std::uint64_t>(bytes, bufferBytes)));
  }
}

void ByteStream::finish()
{
  char next = 0;
  if (impl_->packing == Packing::Deflate && !impl_->ended)
  {
    impl_->inflateSome(&next, 1); // only past the last byte is the checksum compared
  }
}

double ByteStream::fraction() const
{
  return impl_->fileBytes > 0 ? std::min(1.0, double(impl_->given) / double(impl_->fileBytes)) : 1.0;
}

bool isGzip(const std::string& path)
{
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  return file && std::fgetc(file.get()) == firstOfGzip && std::fgetc(file.get()) == 0x8b;
}

} // namespace sono
