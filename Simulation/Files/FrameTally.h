#pragma once

#include <cstddef>
#include <string>

namespace sono {

/// Counts the frames of a file whose number was announced, and says what is wrong with it.
class FrameTally
{
public:
  /// `noun` is what a frame is called: "picture".
  FrameTally(const std::string& path, const std::string& noun, std::size_t count)
    : path_(path)
    , noun_(noun)
    , count_(count)
  {
  }

  /// "picture 3", the one that comes.
  std::string name() const;
  /// It is there. Throws Error for one too many.
  void add();
  /// Throws Error where some are missing.
  void requireAll() const;
  /// Of those that came.
  std::size_t added() const { return added_; }

  /// Throws Error: "cannot write 'path': why."
  [[noreturn]] void refuse(const std::string& why) const;
  /// Throws Error on folder and disk unless what was written is there.
  void requireRoom(bool isWritten) const;

private:
  std::string path_;
  std::string noun_;
  std::size_t count_;
  std::size_t added_ = 0;
};

} // namespace sono
