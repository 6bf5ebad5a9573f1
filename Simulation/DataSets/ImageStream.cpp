#include "DataSets/ImageStream.h"

#include "DataSets/ImageWorkers.h"

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace sono {

namespace {

constexpr int aheadOfWorker = 4; ///< images; of one of 0.5 Mpixel, a megabyte each without channels

} // namespace

/// What the threads put into the stream and the caller takes out.
struct ImageStream::Queue
{
  explicit Queue(const DataSetImager& imager)
    : own(imager.another())
  {
  }

  void put(std::int64_t index, DataSetImage image)
  {
    std::unique_lock<std::mutex> lock(mutex);
    changed.wait(lock, [&] { return stop || made.size() < most; });
    if (stop)
    {
      throw Aborted();
    }
    made.push_back({ index, std::move(image) });
    changed.notify_all();
  }
  void run(const std::vector<PlannedRange>& units, int workers, const Wanted& wanted)
  {
    const auto ofExam = [&](DataSetImager& by, const PlannedRange& exam, const std::function<void()>& done,
                            const Progress& untilStopped) {
      std::vector<std::int64_t> indices;
      for (std::int64_t index = exam.first; index < exam.end; ++index)
      {
        if (!wanted || wanted(index))
        {
          indices.push_back(index);
        }
      }
      if (!indices.empty())
      {
        by.makeEach(
          indices, [&](std::int64_t index, DataSetImage image) { put(index, std::move(image)); }, untilStopped);
      }
      done();
    };
    std::exception_ptr thrown;
    try
    {
      forExams(
        own, units, workers, ofExam, [] {}, [this](double) { return !isStopped(); });
    }
    catch (...)
    {
      thrown = std::current_exception();
    }
    const std::lock_guard<std::mutex> lock(mutex);
    failure = std::move(thrown);
    ended = true;
    changed.notify_all();
  }
  bool isStopped()
  {
    const std::lock_guard<std::mutex> lock(mutex);
    return stop;
  }

  DataSetImager own;
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<StreamedImage> made;
  std::size_t most = 0;
  bool stop = false;
  bool ended = false;
  std::exception_ptr failure;
  std::thread thread;
};

ImageStream::ImageStream(const DataSetImager& imager, const DataSetShare& share, const Wanted& wanted, int workers)
  : queue_(std::make_unique<Queue>(imager))
{
  const int threads = workers > 0 ? workers : imageWorkers(imager);
  const std::vector<PlannedRange> units = workUnits(imager.plan(), imager.plan().imagesOf(share), threads);
  queue_->most = std::size_t(threads * aheadOfWorker);
  queue_->thread = std::thread([queue = queue_.get(), units, threads, wanted] { queue->run(units, threads, wanted); });
}

ImageStream::~ImageStream()
{
  {
    const std::lock_guard<std::mutex> lock(queue_->mutex);
    queue_->stop = true;
    queue_->changed.notify_all();
  }
  queue_->thread.join();
}

bool ImageStream::hasEnded() const
{
  const std::lock_guard<std::mutex> lock(queue_->mutex);
  return queue_->ended && queue_->made.empty() && !queue_->failure;
}

std::optional<StreamedImage> ImageStream::takeMade()
{
  Queue& queue = *queue_;
  const std::lock_guard<std::mutex> lock(queue.mutex);
  if (queue.made.empty())
  {
    if (queue.failure)
    {
      std::rethrow_exception(std::exchange(queue.failure, nullptr));
    }
    return std::nullopt;
  }
  StreamedImage first = std::move(queue.made.front());
  queue.made.pop_front();
  queue.changed.notify_all();
  return first;
}

} // namespace sono
