#include "DataSets/ImageWorkers.h"

#include "Core/ParallelFor.h"
#include "Cuda/DeviceImager.h"
#include "Cuda/OwnImager.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace sono {

namespace {

constexpr int mostWorkersOfDevice = 24;

/// What the workers share.
struct Shared
{
  std::atomic<std::size_t> nextUnit{ 0 };
  std::atomic<bool> stop{ false };
  std::mutex mutex;
  std::condition_variable changed;
  std::int64_t made = 0; ///< that the calling thread has not heard of
  int atWork = 0;
  std::exception_ptr failure;
};

} // namespace

int imageWorkers(const DataSetImager& imager)
{
  if (!imager.runsOnGpu())
  {
    return 1;
  }
  const int threads = int(std::thread::hardware_concurrency()) * 3 / 2; // while some wait for the device
  return std::clamp(threads, 1, mostWorkersOfDevice * int(cudaStatus().devices.size()));
}

std::vector<PlannedRange> workUnits(const DataSetPlan& plan, const PlannedRange& images, int workers)
{
  const std::int64_t perExam = plan.set().imagesPerExam;
  std::vector<PlannedRange> ofBodies;
  for (std::int64_t image = images.first; image < images.end; image += perExam)
  {
    if (ofBodies.empty() || plan.bodyOf(image / perExam) != plan.bodyOf(image / perExam - 1))
    {
      ofBodies.push_back({ image, image });
    }
    ofBodies.back().end = image + perExam;
  }
  const auto bodies = std::int64_t(ofBodies.size());
  std::vector<PlannedRange> units;
  // Of a body's exams those from `from` / `parts` of them on.
  const auto add = [&](const PlannedRange& body, std::int64_t from, std::int64_t to, std::int64_t parts) {
    const std::int64_t exams = (body.end - body.first) / perExam;
    const PlannedRange unit{ body.first + exams * from / parts * perExam, body.first + exams * to / parts * perExam };
    if (unit.first < unit.end)
    {
      units.push_back(unit);
    }
  };
  if (bodies <= workers)
  {
    for (const PlannedRange& body : ofBodies)
    {
      const std::int64_t parts = workers / bodies;
      for (std::int64_t part = 0; part < parts; ++part)
      {
        add(body, part, part + 1, parts);
      }
    }
    return units;
  }
  for (std::int64_t body = 0; body < bodies; ++body)
  {
    add(ofBodies[std::size_t(body)], 0, std::min<std::int64_t>(body + 1, workers), workers);
  }
  for (std::int64_t body = 0; body + 1 < workers; ++body)
  {
    add(ofBodies[std::size_t(body)], body + 1, workers, workers);
  }
  return units;
}

void forExams(DataSetImager& imager, const std::vector<PlannedRange>& units, int workers, const ExamWork& work,
              const std::function<void()>& hear, const Progress& keepsOn)
{
  const std::int64_t perExam = imager.plan().set().imagesPerExam;
  const auto forExamsOf = [&](const PlannedRange& unit, const auto& ofExam) {
    for (std::int64_t image = unit.first; image < unit.end; image += perExam)
    {
      ofExam({ image, image + perExam });
    }
  };
  if (workers == 1)
  {
    const auto done = [&] {
      hear();
      report(keepsOn, 0.0);
    };
    for (const PlannedRange& unit : units)
    {
      forExamsOf(unit, [&](const PlannedRange& exam) { work(imager, exam, done, keepsOn); });
    }
    return;
  }
  const bool onGpu = imager.runsOnGpu();
  Shared shared;
  const Progress untilStopped = [&shared](double) { return !shared.stop; };
  const auto done = [&shared] {
    const std::lock_guard<std::mutex> lock(shared.mutex);
    ++shared.made;
    shared.changed.notify_one();
  };
  const auto run = [&](int number) {
    try
    {
      const OwnImager onDevice(number);
      const LoopsOn ownCore(LoopCores::Own);
      DataSetImager own = imager.another();
      for (std::size_t unit = shared.nextUnit++; unit < units.size(); unit = shared.nextUnit++)
      {
        forExamsOf(units[unit], [&](const PlannedRange& exam) { work(own, exam, done, untilStopped); });
      }
    }
    catch (...)
    {
      const std::lock_guard<std::mutex> lock(shared.mutex);
      shared.failure = shared.failure || shared.stop ? shared.failure : std::current_exception();
      shared.stop = true;
    }
    const std::lock_guard<std::mutex> lock(shared.mutex);
    --shared.atWork;
    shared.changed.notify_one();
  };
  std::vector<std::thread> threads;
  shared.atWork = workers;
  for (int n = 0; n < workers; ++n)
  {
    threads.emplace_back(run, n);
  }
  std::thread devices([onGpu] {
    if (onGpu)
    {
      OwnImager::beginDevices(); // while bodies are prepared
    }
  });
  bool aborted = false;
  std::unique_lock<std::mutex> lock(shared.mutex);
  while (shared.atWork > 0 || shared.made > 0)
  {
    shared.changed.wait_for(lock, std::chrono::milliseconds(50));
    const std::int64_t made = std::exchange(shared.made, 0);
    lock.unlock();
    for (std::int64_t n = 0; n < made; ++n)
    {
      hear();
    }
    if (!aborted && !keepsOn(0.0))
    {
      aborted = true;
      shared.stop = true;
    }
    lock.lock();
  }
  lock.unlock();
  devices.join();
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  if (aborted)
  {
    throw Aborted();
  }
  if (shared.failure)
  {
    std::rethrow_exception(shared.failure);
  }
}

} // namespace sono
