#pragma once

namespace sono {

class DeviceImager;

/// While it lives, what the thread asks a GPU for goes through an imager of its own, so that a device works for several
/// threads side by side. Number n goes to the n-th device, and around again. What the thread makes meanwhile must be
/// fetched and forgotten by it. Nothing happens where there is no GPU.
class OwnImager
{
public:
  explicit OwnImager(int number);
  ~OwnImager();
  OwnImager(const OwnImager&) = delete;
  OwnImager& operator=(const OwnImager&) = delete;

private:
  DeviceImager* imager_ = nullptr;
  int device_ = 0;
};

} // namespace sono
