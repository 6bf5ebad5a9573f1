#pragma once

#include "DataSets/AugmentBody.h"
#include "DataSets/DataSet.h"
#include "DataSets/DataSetSettings.h"
#include "Image/ScanConvert.h"
#include "Phantoms/ThoraxParameters.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace sono {

/// A patient, or one of its copies.
struct PlannedBody
{
  int patient = 0; ///< its number in the file
  int copy = 0;
  Split split = Split::Train;
  BodyAugmentation augmentation;
  std::optional<std::uint64_t> thoraxSeed; ///< of drawThoraxParameters; none: the patient is not drawn
};

/// Of the bundled thorax: the defaults where it is not drawn.
ThoraxParameters thoraxOf(const PlannedBody& body);

/// One image: what it is of, and how it is made.
struct PlannedImage
{
  std::int64_t index = 0;
  std::int64_t exam = 0;
  int body = 0;
  int view = 0;                   ///< of its patient
  std::vector<double> parameters; ///< in the order of DataSet::parameters
  std::uint64_t pathSeed = 0;
  std::uint64_t noiseSeed = 0;
  std::uint64_t scattererSeed = 0; ///< of the exam
};

/// Images, or exams, from `first` to before `end`.
struct PlannedRange
{
  std::int64_t first = 0;
  std::int64_t end = 0;
};

/// Which process of how many.
struct DataSetShare
{
  int rank = 0;
  int of = 1;
};

/// What each image of a data set is. All of it follows from the file's numbers and the number of the image alone, so
/// that any process can make any of them; nothing is kept for an image. Image n belongs to exam n / imagesPerExam;
/// exams are dealt to the bodies in blocks that follow one another, and the views of a patient follow one another in an
/// exam.
class DataSetPlan
{
public:
  explicit DataSetPlan(DataSet set);

  const DataSet& set() const { return set_; }
  std::int64_t imageCount() const { return set_.exams * set_.imagesPerExam; }
  const std::vector<PlannedBody>& bodies() const { return bodies_; }
  const DataSetPatient& patientOf(int body) const;
  int bodyOf(std::int64_t exam) const;
  Split splitOf(std::int64_t image) const;
  std::int64_t imagesIn(Split split) const;

  /// Throws Error where there is no such image; for those who ask from outside.
  void requireImage(std::int64_t index) const;
  PlannedImage image(std::int64_t index) const;
  /// How the probe is held; each attempt holds it otherwise.
  PoseJitter jitter(std::int64_t index, int attempt) const;
  /// The settings of an image.
  DataSetSettings settings(const PlannedImage& image) const;
  /// Each parameter as large as it may be drawn.
  DataSetSettings deepest() const;
  /// Size and place of the picture.
  PlaneImage layout(const PlannedImage& image) const;
  /// The data set's tissues as an exam has them.
  TissueTable tissues(std::int64_t exam) const;
  /// "apical_0000042": the name of the data set and the image's number, with seven digits or what the last one needs.
  std::string caseName(std::int64_t index) const;

  /// The images of a process: whole exams, as many as any other's or one more, one after the other. Throws Error where
  /// the share is none.
  PlannedRange imagesOf(const DataSetShare& share) const;

private:
  BodyAugmentation augmentationOf(const DataSetPatient& patient, std::int64_t body) const;
  void dealSplits();

  DataSet set_;
  DataSetSettings base_;
  std::vector<PlannedBody> bodies_;
  std::vector<std::uint32_t> keys_; ///< of the parameters
  std::array<std::uint32_t, PoseJitter::count> jitterKeys_{};
  int digits_ = 7;
};

} // namespace sono
