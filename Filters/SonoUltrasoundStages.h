#pragma once

#include "BackgroundImage.h"
#include "Simulator.h"
#include "SonoAnatomy.h"
#include "SonoContent.h"
#include "SonoDisplay.h"
#include "SonoProbeField.h"

#include "vtkSmartPointer.h"

#include <array>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

class vtkAlgorithm;
class vtkDataArray;
class vtkDataObject;
class vtkFieldData;
class vtkImageData;
class vtkInformationVector;
class vtkMultiBlockDataSet;
class vtkPointData;
class vtkPolyData;
class vtkSonoBMode;
class vtkSonoImageFormation;
class vtkSonoProbeSource;
class vtkSonoRayTracer;
class vtkSonoScanConverter;
class vtkSonoSceneBuilder;
class vtkSonoUltrasound;

namespace sono {

/// What was made of an input, kept while its content stays.
template<class Made>
struct OfInput
{
  std::optional<std::vector<double>> content; ///< none: it is to be made
  Made made;

  template<class Make>
  const Made& get(vtkDataObject* input, const Make& make)
  {
    std::vector<double> now = input ? contentOf(input) : std::vector<double>();
    if (content != now)
    {
      content.reset(); // stays so when it fails
      made = input ? make() : Made();
      content = std::move(now);
    }
    return made;
  }
};

/// The stages, for their settings, and the simulator that does what they say.
class UltrasoundStages
{
public:
  explicit UltrasoundStages(vtkSonoUltrasound* owner);
  ~UltrasoundStages();

  /// To the scene builder, which was replaced.
  void listenToBuilder();
  std::vector<vtkAlgorithm*> withSettings() const;

  /// What the outputs will be; a GPU begins with them. Throws Error for what is out of range.
  void announce(vtkInformationVector** input, vtkInformationVector* output);
  /// Looks for what an earlier run of the program made of the same files by the same settings. Where there is a
  /// picture, make() takes it and needs no input; outputs that nobody uses are then left empty.
  bool findKept(int port);
  /// Whether somebody uses by now what was left empty.
  bool isLeftWanted() const;
  /// Whether more rounds of paths are traced in the background, and whether make() gives a better result by now.
  bool isRefining() const { return simulator_->isRefining(); }
  bool hasBetter() const { return simulator_->hasBetter(); }
  /// hasBetter(). Only from then on, and once, make() takes the better result over.
  bool offerBetter();
  /// Whether it is still to be taken over.
  bool isBetterOffered() const { return isBetterOffered_ && hasBetter(); }
  /// Begins what the first picture of a moving probe needs.
  void prepareMoving();
  /// See vtkSonoUltrasound.
  bool makeAhead(const double positionMm[3], const double axial[3], const double lateral[3]);
  bool isAheadReady() const { return !ahead_ || ahead_->hasEnded(); }
  /// Makes an announced output; the image and the flat image together. Throws Error, Aborted when the filter is to
  /// stop.
  void make(int port, vtkInformationVector** input, vtkInformationVector* output);

  vtkSmartPointer<vtkSonoSceneBuilder> scene;
  vtkSmartPointer<vtkSonoProbeSource> probe;
  vtkSmartPointer<vtkSonoRayTracer> tracer;
  vtkSmartPointer<vtkSonoImageFormation> formation;
  vtkSmartPointer<vtkSonoBMode> bmode;
  vtkSmartPointer<vtkSonoScanConverter> converter;

private:
  using Inputs = std::array<vtkSmartPointer<vtkDataObject>, 4>;

  /// The part of the whole's progress that a stage reports, with its text.
  Progress progress(vtkAlgorithm* stage, double from, double to);
  static Inputs inputsOf(vtkInformationVector** input);
  void begin(vtkInformationVector** input);
  void beginNext();
  void takeAhead(const ImageInput& image, const Progress& progress);
  const std::vector<TargetSurface>& targets(vtkDataObject* input, vtkMultiBlockDataSet* blocks);
  TracedResult trace(const ImageInput& image);
  void readEchoInputs(const Inputs& inputs, ImageInput& image);
  template<class Result, class Fill>
  void makeLines(const Result& result, Result (*resultOf)(vtkImageData*), const Fill& fill,
                 vtkSmartPointer<vtkImageData>& kept, vtkImageData* lines);
  void makePaths(int port, ImageInput image, int paths, vtkPolyData* output);
  void makeImage(const ImageInput& image, std::optional<double> time, vtkDataArray* errors, vtkImageData* world,
                 vtkImageData* flat);
  std::string keptKey();
  void say(const std::string& sentence);
  bool takeKept(vtkInformationVector* output);
  void givePicture(vtkPointData* arrays, vtkFieldData* fields, vtkInformationVector* output);
  std::string playedKey(const Inputs& inputs);
  bool leavesPlayed(const std::string& key, int port);
  bool takePlayed(const std::string& key, vtkInformationVector* output);
  void keepPlayed(const std::string& key, vtkFieldData* fields);
  void keep(vtkFieldData* fields);
  void makeErrorMap(const ImageInput& image, const TracedResult& traced);

  vtkSonoUltrasound* owner_;
  std::unique_ptr<Anatomy> anatomy_;
  std::unique_ptr<Simulator> simulator_;
  // Of a probe that moves, see makeAhead().
  std::optional<ImageInput> latest_;       ///< that was made
  std::optional<ImageInput> next_;         ///< that is to be made behind what is under way
  std::unique_ptr<Simulator> spare_;       ///< null while it makes an image ahead; takes turns with simulator_
  std::unique_ptr<BackgroundImage> ahead_; ///< null: none
  // As announced.
  ProbeField field_;
  ImageSettings settings_;
  vtkSmartPointer<vtkFieldData> acquisition_;
  // What is made of the inputs.
  OfInput<std::vector<TargetSurface>> targets_;
  std::string targetTissue_;                   ///< and
  std::shared_ptr<const TissueTable> tissues_; ///< which the targets are made with
  OfInput<std::shared_ptr<const PointScatterers>> scatterers_;
  OfInput<std::shared_ptr<const PulseEchoField>> pulseEchoField_;
  std::shared_ptr<const SampledPulse> pulse_;
  vtkMTimeType pulseTime_ = 0; ///< of the stage when it was read; 0: it is to be read
  // The last results, and the arrays that stay as long as they do.
  TracedResult traced_;
  bool isBetterOffered_ = false; ///< to whoever looks on, see vtkSonoUltrasound::HasBetter
  bool isImproved_ = false;      ///< by more rounds, of the same paths
  bool isAsked_ = false;         ///< for what is traced, since the last announcement
  bool isImageAsked_ = false;    ///< for an image, the same
  Display display_;
  ScanPicture picture_;
  vtkSmartPointer<vtkPointData> pictureArrays_;
  std::vector<std::string> traceWarnings_; ///< of what was traced
  /// Scene, collisions, face reflection and depth for which it was last asked whether collisions cut anything off, and
  /// the answer: a probe that moves does not ask again.
  std::tuple<const Scene*, int, double, double> limitAskedFor_;
  std::string limitWarning_;
  std::string key_;               ///< of the picture that is wanted; empty: it is not to be kept
  std::vector<std::string> kept_; ///< of that key; empty: nothing
  std::set<std::string> said_;    ///< of the anatomy of that key
  std::set<int> left_;            ///< ports that were left empty
  ImageResult errorMap_;
  vtkSmartPointer<vtkPointData> errorArrays_;
  vtkSmartPointer<vtkImageData> tracedLines_;
  vtkSmartPointer<vtkImageData> rfLines_;
  vtkSmartPointer<vtkImageData> bmodeLines_;
};

} // namespace sono
