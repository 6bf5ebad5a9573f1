#pragma once

#include "Core/Progress.h"
#include "Echo/PointScatterers.h"
#include "ImageResult.h"
#include "ImageSettings.h"
#include "Scene/Scene.h"
#include "Trace/RecordPaths.h"
#include "Trace/Targets.h"

#include <functional>
#include <memory>
#include <vector>

namespace sono {

/// All that an image is made from, but the scene.
struct ImageInput
{
  ProbePose pose;
  ImageSettings settings;
  std::vector<TargetSurface> targets;
  std::shared_ptr<const PointScatterers> points; ///< null: none
};

/// Pictures of poses that follow one another in a sweep; the memory is the sweep's own and goes after the call.
struct SweptPictures
{
  int firstPose = 0;
  int count = 0;
  const std::uint8_t* grey = nullptr;    ///< count x height x width, see greyBytes
  const std::uint16_t* labels = nullptr; ///< the same, see sliceLabels; null where they were not wanted
  const std::uint8_t* mask = nullptr;    ///< height x width, of every pose
};
using SweepSink = std::function<void(const SweptPictures&)>;

/// A picture with labels, and of its lines the intensity and the depth offsets.
struct SeenPicture
{
  ScanPicture picture;
  std::shared_ptr<const TracedLines> arrivals;
  std::shared_ptr<const DevicePicture> onDevice; ///< null where it was made on the host
  int numberOnDevice = 0;                        ///< of the images there
};

/// Composes the stages, each on the CPU or the GPU as its settings want, and keeps the last result of each. Asked again
/// with the same arguments, a stage gives the same result and does nothing; so only those run again whose arguments
/// changed. A stage that follows another takes its result where it lies. Not for several threads at a time.
///
/// Every call throws as its stage: Error with one sentence, Aborted when asked to stop. The last results stay then.
class Simulator
{
public:
  /// Without a scene the stages after tracing can be run.
  explicit Simulator(std::shared_ptr<const Scene> scene = nullptr);
  ~Simulator();
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

  /// Another scene forgets the results of the one before.
  void setScene(std::shared_ptr<const Scene> scene);
  const std::shared_ptr<const Scene>& scene() const { return scene_; }

  ///@{
  /// Where lines get paths until a target error or a time budget is reached, whether trace() gives the first round's
  /// and the others are traced in the background, until something else is. Otherwise, and on a GPU, it gives the last
  /// one's. Off at first.
  void setProgressive(bool progressive) { progressive_ = progressive; }
  /// Whether more rounds follow.
  bool isRefining() const;
  /// Whether there is a better result by now than trace() gives.
  bool hasBetter() const;
  /// Takes it over; false: there is none.
  bool improve();
  ///@}

  ///@{
  /// The stages one by one.
  TracedResult trace(const std::vector<ScanLine>& lines, const TraceSettings& settings,
                     const std::vector<TargetSurface>& targets = {}, const Progress& progress = {});
  /// Of traced lines the intensity and depth offsets, without the rest where that would have to come from a device.
  static std::shared_ptr<const TracedLines> arrivals(const TracedResult& traced);
  /// `count` of these paths, see recordPaths.
  std::shared_ptr<const std::vector<RecordedPath>> paths(const std::vector<ScanLine>& lines,
                                                         const TraceSettings& settings, int count,
                                                         const std::vector<TargetSurface>& targets = {},
                                                         const Progress& progress = {});
  /// `traced` may be no result: intensity 1 everywhere and no boundaries. `points` may be null. Without a scene only
  /// points echo.
  RfResult formRf(const std::vector<ScanLine>& lines, const TracedResult& traced, const EchoSettings& settings,
                  const std::shared_ptr<const PointScatterers>& points = nullptr, const Progress& progress = {});
  BModeResult makeBMode(const RfResult& rf, const BModeSettings& settings);
  /// `bmode` holds all lines of the geometry.
  ImageResult scanConvert(const ScanGeometry& geometry, const BModeResult& bmode, double pixelMm,
                          const Progress& progress = {});
  /// The image's bytes alone.
  ScanPicture picture(const ImageResult& image);
  /// With the scene's own labels of what is shown at each pixel, see sliceLabels. `traced` are the geometry's lines; it
  /// may be no result: each depth is then shown where it lies.
  ScanPicture picture(const ImageResult& image, const ScanGeometry& geometry, const ProbePose& pose,
                      const TracedResult& traced);
  /// The Monte-Carlo error in the image, percent; see errorPlane. Nothing is known, and the mask is empty, where the
  /// lines are those of a moving probe.
  ImageResult errorMap(const ScanGeometry& geometry, const TracedResult& traced, bool interactive, double pixelMm,
                       const Progress& progress = {});
  ///@}

  ///@{
  /// What a stage gives for an input, those before it included. Throws Error when the stages' settings disagree.
  TracedResult traced(const ImageInput& input, const Progress& progress = {});
  RfResult rf(const ImageInput& input, const Progress& progress = {});
  BModeResult bmode(const ImageInput& input, const Progress& progress = {});
  ImageResult image(const ImageInput& input, const Progress& progress = {});
  /// Has a GPU begin what traced(), or with `wholeImage` image(), will be asked for, so that it is under way by then.
  /// Does nothing on the CPU, nor for a harmonic, whose traces meet on the host, nor in rounds, nor where more is to be
  /// done than can be left to run without a stop.
  void begin(const ImageInput& input, bool wholeImage);
  ///@}

  /// An image of each pose, to the sink, in the order of the poses and on the calling thread. On a GPU a group of poses
  /// goes through the stages together, bytes alone cross the bus, and the sink takes one group while the next is
  /// computed. A pose's picture differs from the one that is made alone by rounding at most, since all poses share one
  /// region of the scene. Throws Error also for a matrix, whose lines fill a volume, and naming the pose that does not
  /// meet the label map. No result is kept. Poses of a harmonic, whose traces meet on the host, run one by one, and so
  /// do those with a target error or a time budget.
  void sweep(const std::vector<ProbePose>& poses, const ImageSettings& settings, bool withLabels, const SweepSink& sink,
             const Progress& progress = {}, const std::vector<TargetSurface>& targets = {});

  /// Of each input what picture() and arrivals() give when it is asked for alone, to the bit. On a GPU those whose
  /// settings differ in path seed and display alone, and whose fans lie in the region that the scene shares, go through
  /// the stages together. Throws Error for a matrix.
  std::vector<SeenPicture> pictures(const std::vector<ImageInput>& inputs, const Progress& progress = {});

  /// Begins to prepare, in the background, what trace() wants of the scene for a probe that moves from here.
  void prepareInteractive(const std::vector<ScanLine>& lines, const TraceSettings& settings);

private:
  /// With the computed beam where it is asked for.
  EchoSettings withBeam(EchoSettings settings, const Progress& progress = {});
  /// `points` with those of the scene that move, as far as lines may hear them, which are asked for where some do.
  std::shared_ptr<const PointScatterers> withMoving(const std::shared_ptr<const PointScatterers>& points,
                                                    const std::function<std::vector<ScanLine>()>& lines,
                                                    const EchoSettings& settings, InterfaceModel model,
                                                    const Progress& progress = {});
  struct LabelsWanted;
  ScanPicture makePicture(const ImageResult& image, const LabelsWanted* wanted);

  struct Last;
  const Scene& needScene() const;

  std::shared_ptr<const Scene> scene_;
  std::unique_ptr<Last> last_;
  bool progressive_ = false;
};

} // namespace sono
