#include "BackgroundImage.h"

#include <chrono>
#include <exception>
#include <utility>

namespace sono {

namespace {

constexpr std::chrono::milliseconds betweenLooks(1);

} // namespace

BackgroundImage::BackgroundImage(std::unique_ptr<Simulator> simulator, ImageInput input)
  : simulator_(std::move(simulator))
  , input_(std::move(input))
  , thread_([this] { run(); })
{
}

BackgroundImage::~BackgroundImage()
{
  stop();
}

void BackgroundImage::run()
{
  try
  {
    const ImageResult image = simulator_->image(input_, [this](double fraction) {
      done_ = fraction;
      return !stop_;
    });
    simulator_->picture(image, input_.settings.geometry, input_.pose, simulator_->traced(input_));
  }
  catch (const std::exception&) // the simulator meets it again, for whoever asks for this image
  {
  }
  ended_ = true;
}

std::unique_ptr<Simulator> BackgroundImage::finish(const Progress& progress)
{
  while (!ended_)
  {
    report(progress, done_);
    std::this_thread::sleep_for(betweenLooks);
  }
  return stop();
}

std::unique_ptr<Simulator> BackgroundImage::stop()
{
  stop_ = true;
  if (thread_.joinable())
  {
    thread_.join();
  }
  return std::move(simulator_);
}

} // namespace sono
