#include "Core/Error.h"
#include "ErrorText.h"
#include "Link/LiveLink.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <random>
#include <thread>
#include <vector>

// What a client sees of it, and what others make of its messages: Testing/Filters/TestLink.py.

namespace sono {
namespace {

LinkPicture smallPicture()
{
  LinkPicture picture;
  picture.width = 40;
  picture.height = 30;
  picture.pose = ProbePose{ { 87.8, -86.5, -45.0 }, { -0.53, 0.65, 0.545 }, { 0.843, 0.333, 0.423 } }.orthonormalized();
  picture.grey.assign(1200, 7);
  return picture;
}

class LiveLinkTest : public ::testing::Test
{
protected:
  void SetUp() override
  {
    try
    {
      requireLinkLibrary();
    }
    catch (const Error& error)
    {
      GTEST_SKIP() << error.what();
    }
  }
};

/// The probe's transform goes out in RAS and comes back as the pose that it was, in single precision.
TEST_F(LiveLinkTest, APoseIsReadAsItWasWritten)
{
  const LinkPicture picture = smallPicture();
  std::string bytes = linkMessages(picture);
  const auto image = readLinkHeader(bytes.data());
  ASSERT_TRUE(image);
  EXPECT_EQ(image->type, "IMAGE");
  bytes.erase(0, linkHeaderBytes + image->bodyBytes);
  const auto probe = readLinkHeader(bytes.data());
  ASSERT_TRUE(probe);
  EXPECT_EQ(probe->type, "TRANSFORM");
  EXPECT_EQ(probe->device, "SonoProbeToReference");
  ASSERT_EQ(bytes.size(), linkHeaderBytes + probe->bodyBytes);
  const ProbePose pose = readLinkPose(bytes);
  EXPECT_LT(glm::length(pose.positionMm - picture.pose.positionMm), 1e-4);
  EXPECT_LT(glm::length(pose.axial - picture.pose.axial), 1e-6);
  EXPECT_LT(glm::length(pose.lateral - picture.pose.lateral), 1e-6);
  bytes.back() = char(bytes.back() ^ 1);
  EXPECT_THROW(readLinkPose(bytes), Error);
  EXPECT_THROW(readLinkPose(bytes.substr(0, linkHeaderBytes + 12)), Error);
}

int connectTo(int port)
{
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(std::uint16_t(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int handle = socket(AF_INET, SOCK_STREAM, 0);
  if (connect(handle, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0)
  {
    close(handle);
    return -1;
  }
  return handle;
}

/// Reads or not, sends what is none or half of a message, and leaves; again and again.
void comeAndGo(int port, unsigned seed, const std::atomic<bool>& isOver)
{
  std::mt19937 random(seed);
  std::vector<char> bytes(1 << 12);
  while (!isOver)
  {
    const int handle = connectTo(port);
    for (int n = 0; handle >= 0 && n < 10 && !isOver; ++n)
    {
      if (seed % 2 == 0 && recv(handle, bytes.data(), bytes.size(), MSG_DONTWAIT) == 0)
      {
        break;
      }
      const std::string message = linkMessages(smallPicture());
      const std::size_t count = random() % message.size();
      const bool isNoise = random() % 4 == 0;
      std::generate(bytes.begin(), bytes.end(), [&] { return char(random()); });
      send(handle, isNoise ? bytes.data() : message.data(), isNoise ? 100 : count, MSG_NOSIGNAL);
    }
    close(handle);
  }
}

TEST_F(LiveLinkTest, ClientsComeAndGoAsTheyLike)
{
  LiveLink link(0, false, "SonoProbeToReference");
  testing::expectContains(testing::errorOf([&] { LiveLink(link.port(), false, "ProbeToReference"); }), "is in use");
  std::atomic<bool> isOver{ false };
  std::vector<std::thread> clients;
  for (unsigned seed = 0; seed < 4; ++seed)
  {
    clients.emplace_back([&, seed] { comeAndGo(link.port(), seed, isOver); });
  }
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  while (std::chrono::steady_clock::now() < end)
  {
    link.show(smallPicture());
    EXPECT_LE(link.state().clients, 16);
  }
  isOver = true;
  for (std::thread& client : clients)
  {
    client.join();
  }
  const int handle = connectTo(link.port());
  EXPECT_GE(handle, 0); // it is still there
  close(handle);
}

} // namespace
} // namespace sono
