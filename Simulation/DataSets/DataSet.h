#pragma once

#include "DataSets/Draw.h"
#include "Labels/TissueTable.h"
#include "Probe/ScanGeometry.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace sono {

/// What a patient's images are for.
enum class Split
{
  Train,
  Validation,
  Test
};
constexpr int splitCount = 3;
/// "train", "validation", "test".
const char* nameOf(Split split);

enum class DataSetFormat
{
  NnUNet, ///< imagesTr, labelsTr, imagesTs, labelsTs, dataset.json, splits_final.json
  Monai   ///< images, labels and a data list dataset.json
};

/// What an image's OpenEXR files may hold, see ImageChannels.h.
enum class ImageChannel
{
  Grey,
  Mask,
  Label,
  Tissue,
  Error,
  Beam ///< a file of its own, in beam space
};
constexpr int imageChannelCount = 6;
/// "grey", "mask", "label", "tissue", "error", "beam".
const char* nameOf(ImageChannel channel);

/// Where the probe stands before it is jittered.
struct DataSetView
{
  std::string name;
  std::optional<ProbePose> pose; ///< world LPS mm, of the patient as the file has it
  /// Of what findAcousticWindows finds for a label or an organ the best; empty, and no pose: the standard view of that
  /// name (findStandardViews), of the bundled thorax that is not drawn its A4C the pose that it brings along.
  std::string window;
};

/// An anatomy, and how often it is used.
struct DataSetPatient
{
  std::string id;
  std::string labels;     ///< path of the label map; empty: the bundled thorax
  std::string names;      ///< path of a table of its labels; empty: none
  double spacingMm = 1.0; ///< of the bundled thorax
  bool isDrawn = false;   ///< each copy of the bundled thorax is another body, see drawThoraxParameters
  std::string licence;
  std::string provenance;
  int copies = 1;             ///< bodies made of it, each changed by itself by the draws that follow
  Draw stretch = always(1.0); ///< factor, for each of the grid's three axes
  Draw extraFatMm = always(0.0);
  Draw warpAmplitudeMm = always(0.0);
  Draw warpWavelengthMm = always(1.0);
  Draw mirror = always(0.0);  ///< 1: left for right, see BodyAugmentation
  std::optional<Split> split; ///< none: drawn
  std::vector<DataSetView> views;
};

/// How far off its view the probe is held, drawn for each image: degrees and millimetres, in the view's own frame.
struct PoseJitter
{
  double tiltDeg = 0.0;     ///< out of the plane, about lateral
  double rockDeg = 0.0;     ///< in the plane, about elevation
  double rotationDeg = 0.0; ///< about axial
  double slideLateralMm = 0.0;
  double slideElevationMm = 0.0;
  double pressMm = 0.0; ///< into the skin, see pressedIn

  /// Visits each number and its name in a file.
  template<class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor(self.tiltDeg, "tiltDeg");
    visitor(self.rockDeg, "rockDeg");
    visitor(self.rotationDeg, "rotationDeg");
    visitor(self.slideLateralMm, "slideLateralMm");
    visitor(self.slideElevationMm, "slideElevationMm");
    visitor(self.pressMm, "pressMm");
  }

  static constexpr std::size_t count = 6;
};

/// Whose settings a parameter belongs to.
enum class SettingsGroup
{
  Probe,   ///< ProbeSettings: drawn for each exam; the others for each image
  Tracing, ///< TraceSettings
  Echo,    ///< EchoSettings, and its sampling
  Display  ///< BModeSettings
};
/// The keys of the file: "probe", "tracing", "echo", "display".
const char* nameOf(SettingsGroup group);

/// A parameter of the simulation (Core/Parameters.h), by the name that its settings struct gives it.
struct DrawnParameter
{
  SettingsGroup group = SettingsGroup::Probe;
  std::string name;
  Draw draw;
};

/// The tissue outside the bodies.
constexpr const char* couplingTissue = "air";

/// A number of a tissue, drawn for each exam.
struct DrawnTissue
{
  std::string tissue; ///< "*": of each tissue but couplingTissue by itself
  TissueColumn column;
  bool isFactor = false; ///< of the table's number
  Draw draw;
};

/// Labels that share a value of the masks.
struct MaskGroup
{
  std::string name;
  std::vector<std::string> labels; ///< patterns of words, see LabelTissueMap; the first group that fits a label has it
  /// Of what an image holds of it: the probe is held anew where less lies in no shadow, see maskSufficiency().
  double leastVisiblePercent = 0.0;
};

/// Groups of the masks that a straight line between the mitral annulus' hinges divides, as annotators do.
struct MitralLineGroups
{
  std::string ventricle; ///< names of groups
  std::string atrium;
  std::vector<std::string> valve; ///< patterns of labels, as those of a group
};

/// A data set as one file declares it. Data/datasets/schema.json and Data/docs/datasets.md say what each key means.
struct DataSet
{
  std::string path; ///< of the file
  std::string text; ///< its bytes
  std::string name;
  std::string description;
  std::uint64_t seed = 0;
  std::int64_t exams = 1;
  int imagesPerExam = 1;
  std::vector<DataSetPatient> patients;
  std::array<double, splitCount> splitShares{ 0.7, 0.15, 0.15 }; ///< of the bodies whose split is drawn; sum 1
  /// In the order of PoseJitter.
  std::array<Draw, PoseJitter::count> jitter{ always(0), always(0), always(0), always(0), always(0), always(0) };
  ProbeSettings probe;
  std::vector<DrawnParameter> parameters;
  double pixelMm = 0.5;
  TissueTable tissues;
  std::string labelTissues; ///< path of the table which label is which tissue
  std::vector<DrawnTissue> drawnTissues;
  std::vector<MaskGroup> masks; ///< value n + 1 in a mask; 0 is everything else
  std::optional<MitralLineGroups> mitralLine;
  DataSetFormat format = DataSetFormat::NnUNet;
  std::vector<ImageChannel> channels; ///< of each image's OpenEXR files, beside its PNGs; empty: there are none
};

/// Reads and checks a declarative file (JSON). Paths in it are relative to it; presets, tables and probes that come
/// with SonoVDB lie in `dataFolder`. Throws Error, in one sentence that names the file and the key, for a key that is
/// unknown, missing or there twice, a value of the wrong type, a range that is upside down or wider than the
/// parameter's own, a probe, tissue or file that is not there.
DataSet readDataSet(const std::string& path, const std::string& dataFolder);

} // namespace sono
