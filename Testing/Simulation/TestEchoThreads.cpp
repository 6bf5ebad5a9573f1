// Several threads may image one scene at once: pieces of its surfaces are made on first need, and tables are shared.
#include "BusyScene.h"
#include "EchoScenes.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace sono::test {
namespace {

TEST(EchoThreads, ManyImageOneSceneAsOneDoes)
{
  const std::vector<ScanLine> lines = fan(4);
  std::vector<EchoSettings> settings(4);
  for (std::size_t i = 0; i < settings.size(); ++i)
  {
    settings[i].depthMm = 30.0;
    settings[i].centreFrequencyMHz = 2.0 + 0.5 * double(i / 2); // two of each want the same tables
  }
  const auto image = [&lines](const Scene& scene, const EchoSettings& s) {
    return formRf(scene, lines, fullyLit(lines.size(), s, InterfaceModel::Acoustic), s).iq;
  };
  const auto shared = makeBusyScene();
  std::vector<std::vector<std::complex<float>>> together(settings.size());
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < settings.size(); ++i)
  {
    threads.emplace_back([&, i] { together[i] = image(*shared, settings[i]); });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  for (std::size_t i = 0; i < settings.size(); ++i)
  {
    const auto alone = image(*makeBusyScene(), settings[i]);
    EXPECT_TRUE(std::any_of(alone.begin(), alone.end(), [](const auto& v) { return std::abs(v) > 0.0f; }));
    EXPECT_EQ(together[i], alone) << i;
  }
}

} // namespace
} // namespace sono::test
