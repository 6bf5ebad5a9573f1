#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

namespace sono {

/// A handle of what a stage has made, where it lies: on the host, or on the device. Copies are the same result. What
/// lies on the device stays valid whatever the device makes next, and is copied to the host when somebody asks.
/// `Host` is the result's struct on the host, `OnDevice` what holds it on the device.
template<class Host, class OnDevice>
class StageResult
{
public:
  using Fetch = std::function<void(const OnDevice&, Host&)>; ///< fills the arrays of a layout; throws Error

  /// No result.
  StageResult() = default;
  /// On the host.
  explicit StageResult(Host made)
    : state_(std::make_shared<State>(std::move(made), nullptr, nullptr))
  {
  }
  /// On the device; `layout` is the host's struct without its arrays.
  StageResult(Host layout, std::shared_ptr<const OnDevice> device, Fetch fetch)
    : state_(std::make_shared<State>(std::move(layout), std::move(device), std::move(fetch)))
  {
  }

  explicit operator bool() const { return state_ != nullptr; }
  /// Whether both are the same result.
  bool operator==(const StageResult& other) const { return state_ == other.state_; }

  /// Its numbers, whether or not its arrays are here.
  const Host& layout() const { return state_->made; }
  /// With its arrays; the first call copies them down. Several threads may ask. Throws Error when the device fails.
  const Host& host() const
  {
    if (!state_->device)
    {
      return state_->made;
    }
    const std::lock_guard<std::mutex> lock(state_->mutex);
    if (!state_->fetched)
    {
      Host host = state_->made;
      state_->fetch(*state_->device, host);
      state_->fetched = std::move(host);
    }
    return *state_->fetched;
  }
  /// Null when it lies on the host.
  const std::shared_ptr<const OnDevice>& onDevice() const { return state_->device; }

private:
  struct State
  {
    State(Host madeOrLayout, std::shared_ptr<const OnDevice> onDevice, Fetch fetchIt)
      : made(std::move(madeOrLayout))
      , device(std::move(onDevice))
      , fetch(std::move(fetchIt))
    {
    }

    const Host made;
    const std::shared_ptr<const OnDevice> device;
    const Fetch fetch;
    std::mutex mutex;
    std::optional<Host> fetched;
  };
  std::shared_ptr<State> state_;
};

} // namespace sono
