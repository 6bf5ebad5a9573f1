#pragma once

#include "Core/Device.h"
#include "Core/Progress.h"
#include "DataSets/ChannelImage.h"
#include "DataSets/DataSetPlan.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace sono {

struct DeviceBytes;
struct SeenPicture;

/// A picture of a data set with its mask, rows from the transducer on, lateral fastest.
struct DataSetImage
{
  int width = 0;
  int height = 0;
  double pixelMm = 0.0;
  double lateralMinMm = 0.0; ///< of the first pixel, in the probe's plane
  double axialMinMm = 0.0;
  std::vector<std::uint8_t> grey;  ///< see greyBytes
  std::vector<std::uint8_t> mask;  ///< n + 1: mask group n; 0: another label, or outside the scanned area
  std::vector<std::string> groups; ///< names of the mask groups
  /// JSON: what was drawn, all settings, the tissues' numbers, the pose, licence and provenance of the patient, and
  /// flags (see Data/docs/datasets.md).
  std::string info;
  ///@{
  /// What the file asks for as channels, see ImageChannels.h; without pixels where it does not.
  ChannelImage channels;
  ChannelImage beam;
  ///@}
  ///@{
  /// The same bytes as `grey` and `mask`, where the imager keeps them on a GPU; else null.
  std::shared_ptr<const DeviceBytes> greyOnGpu;
  std::shared_ptr<const DeviceBytes> maskOnGpu;
  ///@}
};

using DataSetSink = std::function<void(std::int64_t index, DataSetImage image)>;

/// Makes the images of a plan, whichever are asked for. Keeps the last patient's labels and the last body's scene, so
/// that images of one body are quick one after the other. An image does not depend on those before it, to the bit. Not
/// for several threads at a time.
///
/// A patient's views are looked for once, with the file's probe and the table's tissues. One that is not obtainable is
/// replaced by the next in the patient's list that is.
class DataSetImager
{
public:
  explicit DataSetImager(std::shared_ptr<const DataSetPlan> plan, Device device = Device::Auto);
  ~DataSetImager();
  DataSetImager(const DataSetImager&) = delete;
  DataSetImager& operator=(const DataSetImager&) = delete;
  DataSetImager(DataSetImager&&) noexcept;
  /// From now on what is shown of images stays on the GPU as well, for those who read it there. Throws Error where none
  /// makes them.
  void keepOnGpu();
  /// Of the same plan, for another thread: they share the patients and what was found of bodies, and prepare a few
  /// bodies at a time.
  DataSetImager another() const;

  const DataSetPlan& plan() const { return *plan_; }
  /// Throws Error where the device is a GPU that cannot be used.
  bool runsOnGpu() const;
  /// Throws Error, naming the data set and the image, when there is no such image, its patient cannot be read or no
  /// pose that is drawn for it stands on the skin; Aborted.
  DataSetImage make(std::int64_t index, const Progress& progress = {});
  /// Several images of one exam, to the sink as they are there; a GPU makes them together. Throws as make().
  void makeEach(const std::vector<std::int64_t>& indices, const DataSetSink& sink, const Progress& progress = {});

private:
  struct Patient;
  struct Found;
  struct Shared;
  struct Body;
  struct PlacedImage;

  std::shared_ptr<const Patient> makePatient(const PlannedBody& body, const Progress& progress) const;
  void prepareBody(int body, const Progress& progress);
  void prepareExam(const PlannedImage& image, const Progress& progress);
  template<class Do>
  void named(const PlannedImage& image, const Do& work) const;
  PlacedImage place(const PlannedImage& image);
  void hold(PlacedImage& placed, int view, double& best);
  DataSetImage finish(const PlacedImage& placed, const SeenPicture& seen);

  std::shared_ptr<const DataSetPlan> plan_;
  Device device_;
  bool keepsOnGpu_ = false;
  std::shared_ptr<Shared> shared_;
  std::shared_ptr<const Patient> patient_;
  std::unique_ptr<Body> body_;
};

} // namespace sono
