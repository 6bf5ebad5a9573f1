#include "Link/LiveLink.h"

#include "Core/Error.h"
#include "Link/LinkClient.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <list>
#include <mutex>
#include <thread>
#include <vector>

namespace sono {

namespace {

constexpr std::size_t mostClients = 16;

/// A socket that waits for clients. Throws Error.
OwnHandle listenAt(int port, bool isOpen)
{
  OwnHandle handle(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int yes = 1; // a port whose last server just ended is free
  setsockopt(handle.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(std::uint16_t(port));
  address.sin_addr.s_addr = htonl(isOpen ? INADDR_ANY : INADDR_LOOPBACK);
  if (bind(handle.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
      listen(handle.get(), int(mostClients)) != 0)
  {
    const bool isTaken = errno == EADDRINUSE;
    throw Error("Port " + std::to_string(port) +
                (isTaken ? " is in use, by another program or another Live Link; choose another one."
                         : std::string(" cannot be used (") + std::strerror(errno) + "); choose another one."));
  }
  return handle;
}

int portOf(int handle)
{
  sockaddr_in address{};
  socklen_t length = sizeof(address);
  getsockname(handle, reinterpret_cast<sockaddr*>(&address), &length);
  return ntohs(address.sin_port);
}

} // namespace

/// The thread and what it shares.
class LiveLink::Server
{
public:
  Server(int port, bool isOpen, const std::string& transform)
    : transform_(transform)
    , listener_(listenAt(port, isOpen))
    , wake_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC))
    , port_(portOf(listener_.get()))
    , thread_([this] { run(); })
  {
  }

  ~Server()
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      isEnding_ = true;
    }
    wake();
    thread_.join();
  }

  int port() const { return port_; }

  void show(const LinkPicture& picture)
  {
    auto bytes = std::make_shared<const std::string>(linkMessages(picture));
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      newest_ = std::move(bytes);
    }
    wake();
  }

  LinkState state() const
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return state_;
  }

private:
  void wake() const
  {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t ignored = write(wake_.get(), &one, sizeof(one));
  }

  void say(const std::string& sentence)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    state_.notice = sentence;
  }

  void run()
  {
    std::list<LinkClient> clients;
    for (;;)
    {
      std::shared_ptr<const std::string> newest;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (isEnding_)
        {
          return;
        }
        state_.clients = int(clients.size());
        newest = newest_;
      }
      std::vector<pollfd> waited{ { listener_.get(), POLLIN, 0 }, { wake_.get(), POLLIN, 0 } };
      for (LinkClient& client : clients)
      {
        const bool hasMore = client.offer(newest);
        waited.push_back({ client.handle(), short(hasMore ? POLLIN | POLLOUT : POLLIN), 0 });
      }
      poll(waited.data(), nfds_t(waited.size()), -1);
      std::uint64_t ignored = 0;
      while (read(wake_.get(), &ignored, sizeof(ignored)) > 0)
      {
      }
      auto ready = waited.begin() + 2;
      for (auto client = clients.begin(); client != clients.end(); ++ready)
      {
        const bool isThere = serve(*client, ready->revents);
        client = isThere ? std::next(client) : clients.erase(client);
      }
      if (waited[0].revents != 0)
      {
        welcome(clients);
      }
    }
  }

  void welcome(std::list<LinkClient>& clients)
  {
    OwnHandle handle(accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (handle.get() < 0)
    {
      return;
    }
    if (clients.size() == mostClients)
    {
      say("More than " + std::to_string(mostClients) + " clients wanted to connect; the last was refused.");
      return;
    }
    clients.emplace_back(std::move(handle));
  }

  /// False where the client is gone or is let go.
  bool serve(LinkClient& client, short events)
  {
    try
    {
      if ((events & POLLOUT) != 0 && !client.send())
      {
        return false;
      }
      const auto take = [this](const LinkHeader& header, const std::string& message) {
        takeTransform(header, message);
      };
      return (events & (POLLIN | POLLHUP | POLLERR)) == 0 || client.receive(take);
    }
    catch (const Error& error)
    {
      say(error.what());
      return false;
    }
  }

  void takeTransform(const LinkHeader& header, const std::string& message)
  {
    if (header.device != transform_)
    {
      say("A client sends the transform '" + header.device + "', and the probe follows '" + transform_ +
          "'; give both the same name.");
      return;
    }
    try
    {
      const ProbePose pose = readLinkPose(message);
      const std::lock_guard<std::mutex> lock(mutex_);
      state_.pose = pose;
      ++state_.poseCount;
      state_.notice.clear();
    }
    catch (const Error& error)
    {
      say("A transform '" + header.device + "' was left out: " + error.what() + ".");
    }
  }

  const std::string transform_;
  OwnHandle listener_;
  OwnHandle wake_;
  const int port_;
  mutable std::mutex mutex_; // of what follows
  bool isEnding_ = false;
  std::shared_ptr<const std::string> newest_;
  LinkState state_;
  std::thread thread_; // last: it uses all that
};

LiveLink::LiveLink(int port, bool isOpen, const std::string& transform)
{
  requireLinkLibrary();
  server_ = std::make_unique<Server>(port, isOpen, transform);
}

LiveLink::~LiveLink() = default;

int LiveLink::port() const
{
  return server_->port();
}

void LiveLink::show(const LinkPicture& picture)
{
  server_->show(picture);
}

LinkState LiveLink::state() const
{
  return server_->state();
}

} // namespace sono
