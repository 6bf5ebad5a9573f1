#pragma once

#include <string>

namespace sono {

/// The formats of lines and channels.
enum class EchoFormat
{
  Zea,
  Uff
};

/// By the name's ending. Throws Error naming the file for another one.
EchoFormat echoFormatOf(const std::string& path);

} // namespace sono
