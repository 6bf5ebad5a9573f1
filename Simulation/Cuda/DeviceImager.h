#pragma once

#include "Core/Progress.h"
#include "Core/SharedSpan.h"
#include "Cuda/DeviceBytes.h"
#include "Cuda/ImageJob.h"

#include <complex>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace sono {

// What a stage has left on the device. Complete where nvcc compiles; others hold it only. It stays as it is, whatever
// the device makes next, and its memory goes back when nobody holds it any more.

struct DeviceTraced;     ///< intensities, their errors, attenuation and boundary echoes of some lines
struct DeviceRf;         ///< IQ and envelopes of some lines
struct DeviceGrey;       ///< grey levels in beam space, of one image or several of equally many lines
struct DevicePicture;    ///< scan-converted bytes of those images, and their mask
struct DeviceLabelSlice; ///< the labels of their pixels

/// Lines of a job.
struct LineRange
{
  int first = 0;
  int count = 0;
};

/// What fetch() brings of traced lines; see TracedLines.
struct FetchedTrace
{
  std::vector<std::vector<float>> bins; ///< in the order of BinArray
  std::vector<std::complex<float>> boundaryEcho;
  std::uint64_t segments = 0;
};

/// Of these what says where sound arrives, and when.
struct FetchedArrivals
{
  std::vector<float> intensity;
  std::vector<float> depthOffsetMm; ///< empty: range is depth
};

/// Bytes of pictures on their way to the host, in pinned memory; `labels` where they were wanted.
struct PictureCopy
{
  SharedSpan<std::uint8_t> bytes;
  SharedSpan<std::uint16_t> labels;
  SharedSpan<std::uint8_t> mask; ///< one for all images
};

/// Device times of the last run of each stage, ms, from events; and what has crossed the bus in this process.
struct DeviceTimes
{
  double trace = 0.0;
  double echo = 0.0;
  double bmode = 0.0;
  double scan = 0.0;
  std::uint64_t uploadedBytes = 0;
  std::uint64_t downloadedBytes = 0;
};

/// Whether this process can compute on a GPU. Asked once.
struct DeviceStatus
{
  bool usable = false;
  std::string what; ///< the first GPU's name and memory, or one clause that says why there is none
  std::uint64_t memoryBytes = 0;
  std::vector<int> devices; ///< those that can be used, by CUDA's numbers
};
const DeviceStatus& cudaStatus();

enum class Waiting;

/// Runs the stages on a CUDA device. A stage returns when its work is asked for; whoever fetches waits for it.
/// What a scene does not change (voxels, boundary records, fields), and the tables of a job that was given before, are
/// on the device already. One caller at a time; others wait. The result does not depend on the order in which threads
/// run, to the bit. All throw Error naming the bytes when the device has no room, and the failure when it was lost; the
/// imager stays usable, what it kept for itself being given back.
class DeviceImager
{
public:
  /// The thread's imager: its own while an OwnImager lives, else the process's, on the first device. Throws Error when
  /// there is no usable device.
  static DeviceImager& instance();

  /// Throws Aborted when asked to stop.
  std::shared_ptr<const DeviceTraced> trace(const std::shared_ptr<const TraceJob>& job, LineRange lines,
                                            const Progress& progress = {});
  /// All lines of both jobs, which are the same, and of the tone sent and twice it: what secondHarmonic makes of them.
  std::shared_ptr<const DeviceTraced> traceHarmonic(const std::shared_ptr<const TraceJob>& sent,
                                                    const std::shared_ptr<const TraceJob>& doubled,
                                                    const HarmonicJob& harmonic, const Progress& progress = {});
  /// Uploads for formRf(). Asked for before trace(), its search for surfaces need not wait for the trace.
  void prepare(const std::shared_ptr<const EchoJob>& job);
  /// `traced` holds the same lines, or is null, where the job's own `given` is taken. The IQ, if it is wanted, beside
  /// the envelope.
  std::shared_ptr<const DeviceRf> formRf(const std::shared_ptr<const EchoJob>& job, LineRange lines,
                                         const DeviceTraced* traced, bool wantsIq);
  std::shared_ptr<const DeviceGrey> compress(const std::shared_ptr<const BModeJob>& job, const DeviceRf& rf,
                                             int images);
  /// The same, each image of `rf` by a job of its own.
  std::shared_ptr<const DeviceGrey> compress(const std::vector<std::shared_ptr<const BModeJob>>& ofImages,
                                             const DeviceRf& rf);
  std::shared_ptr<const DevicePicture> convert(const PlaneScan& scan, std::shared_ptr<const DeviceGrey> grey);
  std::shared_ptr<const DeviceLabelSlice> slice(const LabelJob& job, const DevicePicture& picture,
                                                const DeviceTraced* traced);

  FetchedTrace fetch(const DeviceTraced& traced);
  FetchedArrivals fetchArrivals(const DeviceTraced& traced);
  std::vector<std::complex<float>> fetchIq(const DeviceRf& rf);
  /// Grey levels in beam space, and the reference amplitude of each image.
  std::vector<float> fetch(const DeviceGrey& grey, std::vector<double>& reference);
  /// The pixels as levels from 0 to 1; 0 outside.
  std::vector<float> fetchLevels(const DevicePicture& picture);

  /// Which pixels lie inside.
  SharedSpan<std::uint8_t> maskOf(const DevicePicture& picture);

  /// A copy to the host beside whatever is computed meanwhile; wait() gives it.
  class Download;
  std::shared_ptr<Download> beginDownload(std::shared_ptr<const DevicePicture> picture,
                                          std::shared_ptr<const DeviceLabelSlice> labels = nullptr);
  PictureCopy wait(const std::shared_ptr<Download>& download);

  /// The bytes of one of a picture's images, where they are; they are there.
  DeviceBytes bytesOf(std::shared_ptr<const DevicePicture> picture, int image);
  /// Bytes that are there when this returns.
  DeviceBytes upload(const std::vector<std::uint8_t>& bytes);

  /// Images of this many bytes (see bytesPerImage) that fit beside each other, at least 1.
  int imagesThatFit(double bytesPerImage);
  /// Waits for all that was asked for.
  DeviceTimes lastTimes();

private:
  friend class OwnImager;
  DeviceImager(int device, Waiting waiting);
  /// Gives back what is kept on the device.
  void forget();
  struct Work;
  template<class Do>
  auto guarded(const Do& work);
  std::unique_ptr<Work> work_;
};

} // namespace sono
