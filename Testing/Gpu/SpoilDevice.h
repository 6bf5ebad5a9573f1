#pragma once

namespace sono::test {

/// Takes the device's memory but for about 64 MB until it is destroyed.
class TakenMemory
{
public:
  TakenMemory();
  ~TakenMemory();
  TakenMemory(const TakenMemory&) = delete;
  TakenMemory& operator=(const TakenMemory&) = delete;

private:
  void* taken_ = nullptr;
};

/// Lets a kernel trap: CUDA is lost for this process.
void loseDevice();

} // namespace sono::test
