#pragma once

namespace sono {

class DeviceImager;

/// While it lives, what the thread asks a GPU for goes through an imager of its own, so that a device works for several
/// threads side by side. Number n goes to the n-th device, and around again. What the thread makes meanwhile must be
/// fetched and forgotten by it. Nothing happens where there is no GPU, nor before the thread asks it for something.
class OwnImager
{
public:
  explicit OwnImager(int number);
  ~OwnImager();
  OwnImager(const OwnImager&) = delete;
  OwnImager& operator=(const OwnImager&) = delete;

  /// Has the driver begin with all devices, which takes it a second or more, while other threads do what asks for none.
  static void beginDevices();

private:
  friend class DeviceImager;
  DeviceImager& imager();

  int number_;
  int device_ = 0;
  DeviceImager* imager_ = nullptr;
};

} // namespace sono
