#include "Link/LinkClient.h"

#include "Core/Error.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace sono {

namespace {

/// What the system keeps for a client that reads slowly: more would be pictures of long ago.
constexpr int keptBytes = 1 << 18;
constexpr std::uint64_t longestTransform = 1 << 16;
constexpr std::uint64_t longestMessage = 1ull << 32;

/// Whether the socket has only nothing to do.
bool isWaiting(ssize_t count)
{
  return count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
}

} // namespace

OwnHandle::~OwnHandle()
{
  if (handle_ >= 0)
  {
    close(handle_);
  }
}

LinkClient::LinkClient(OwnHandle handle)
  : handle_(std::move(handle))
{
  const int yes = 1;
  setsockopt(handle_.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof(yes));
  setsockopt(handle_.get(), SOL_SOCKET, SO_SNDBUF, &keptBytes, sizeof(keptBytes));
}

bool LinkClient::offer(const std::shared_ptr<const std::string>& newest)
{
  if (newest != last_ && (!last_ || sent_ == last_->size()))
  {
    last_ = newest;
    sent_ = 0;
  }
  return last_ && sent_ < last_->size();
}

bool LinkClient::send()
{
  const ssize_t count = ::send(handle_.get(), last_->data() + sent_, last_->size() - sent_, MSG_NOSIGNAL);
  if (count < 0)
  {
    return isWaiting(count);
  }
  sent_ += std::size_t(count);
  return true;
}

bool LinkClient::receive(const TakeTransform& take)
{
  char part[1 << 16];
  const ssize_t count = recv(handle_.get(), part, sizeof(part), 0);
  if (count <= 0)
  {
    return isWaiting(count);
  }
  received_.append(part, std::size_t(count));
  takeMessages(take);
  return true;
}

void LinkClient::takeMessages(const TakeTransform& take)
{
  for (;;)
  {
    const std::uint64_t gone = std::min<std::uint64_t>(passed_, received_.size());
    received_.erase(0, std::size_t(gone));
    passed_ -= gone;
    if (received_.size() < linkHeaderBytes)
    {
      return;
    }
    const std::optional<LinkHeader> header = readLinkHeader(received_.data());
    if (!header || header->bodyBytes > longestMessage)
    {
      throw Error("A client sent something that is no OpenIGTLink message, and was let go.");
    }
    const std::uint64_t bytes = linkHeaderBytes + header->bodyBytes;
    if (header->type != "TRANSFORM" || header->bodyBytes > longestTransform)
    {
      passed_ = bytes;
      continue;
    }
    if (received_.size() < bytes)
    {
      return;
    }
    take(*header, received_.substr(0, std::size_t(bytes)));
    passed_ = bytes;
  }
}

} // namespace sono
