#pragma once

#include "Link/LinkMessages.h"

#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace sono {

/// A file descriptor that is closed with its owner.
class OwnHandle
{
public:
  explicit OwnHandle(int handle)
    : handle_(handle)
  {
  }
  ~OwnHandle();
  OwnHandle(OwnHandle&& other) noexcept
    : handle_(std::exchange(other.handle_, -1))
  {
  }
  OwnHandle(const OwnHandle&) = delete;
  OwnHandle& operator=(const OwnHandle&) = delete;
  OwnHandle& operator=(OwnHandle&&) = delete;

  int get() const { return handle_; }

private:
  int handle_;
};

/// One who is connected, by a socket that does not block.
class LinkClient
{
public:
  explicit LinkClient(OwnHandle handle);

  int handle() const { return handle_.get(); }

  /// What is newest: it is sent when what is on its way has left, whole, and nothing newer has come. Whether there is
  /// something to send.
  bool offer(const std::shared_ptr<const std::string>& newest);
  /// As much as the socket takes. False where the client is gone.
  bool send();

  using TakeTransform = std::function<void(const LinkHeader&, const std::string&)>;
  /// What has come; TRANSFORM messages are handed on, others passed over. False where the client is gone. Throws Error
  /// for what is no OpenIGTLink.
  bool receive(const TakeTransform& take);

private:
  void takeMessages(const TakeTransform& take);

  OwnHandle handle_;
  std::shared_ptr<const std::string> last_; ///< that was sent or is on its way
  std::size_t sent_ = 0;                    ///< of it
  std::string received_;
  std::uint64_t passed_ = 0; ///< bytes that follow and are nobody's
};

} // namespace sono
