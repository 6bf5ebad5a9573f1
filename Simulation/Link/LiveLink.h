#pragma once

#include "Link/LinkMessages.h"

#include <cstdint>
#include <memory>
#include <string>

namespace sono {

/// What a live link knows of those who are connected.
struct LinkState
{
  int clients = 0;
  std::uint64_t poseCount = 0; ///< that came, of which only the newest counts
  ProbePose pose;              ///< that one
  std::string notice;          ///< a sentence on what went wrong last; empty: nothing
};

/// An OpenIGTLink server: it shows 3D Slicer, PLUS and others the newest picture with its pose (see linkMessages), and
/// takes from them where the probe is, a TRANSFORM of one name. It works in a thread of its own and never waits for a
/// client: who reads slowly gets fewer pictures, each of them whole.
class LiveLink
{
public:
  /// `port`: 1 to 65535; 0 takes any that is free. Where `isOpen`, other computers may connect, too. Throws Error where
  /// the port is taken, and where there is no OpenIGTLink.
  LiveLink(int port, bool isOpen, const std::string& transform);
  ~LiveLink();

  int port() const;
  /// The picture that is shown from now on. Returns at once.
  void show(const LinkPicture& picture);
  LinkState state() const;

private:
  class Server;
  std::unique_ptr<Server> server_;
};

} // namespace sono
