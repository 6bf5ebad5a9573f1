#pragma once

#include "Simulator.h"

#include <atomic>
#include <memory>
#include <thread>

namespace sono {

/// An image that a simulator makes on a thread of its own, before it is asked for: of a probe that moves on, while its
/// last picture is drawn.
class BackgroundImage
{
public:
  /// Begins. Whoever shares the simulator's scene may use it meanwhile.
  BackgroundImage(std::unique_ptr<Simulator> simulator, ImageInput input);
  /// Stops it, within milliseconds.
  ~BackgroundImage();
  BackgroundImage(const BackgroundImage&) = delete;
  BackgroundImage& operator=(const BackgroundImage&) = delete;

  const ImageInput& input() const { return input_; }
  /// Whether there is nothing to wait for.
  bool hasEnded() const { return ended_; }
  /// The simulator with what it has made as its last results, after it has ended. Where it failed, or was stopped, it
  /// says so when it is asked for the same again. Throws Aborted when asked to stop.
  std::unique_ptr<Simulator> finish(const Progress& progress);
  /// The same at once.
  std::unique_ptr<Simulator> stop();

private:
  void run();

  std::unique_ptr<Simulator> simulator_; ///< the thread's until it has ended
  ImageInput input_;
  std::atomic<double> done_{ 0.0 };
  std::atomic<bool> stop_{ false };
  std::atomic<bool> ended_{ false };
  std::thread thread_;
};

} // namespace sono
