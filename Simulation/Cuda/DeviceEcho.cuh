#pragma once

#include "Cuda/DeviceMemory.cuh"
#include "Cuda/DeviceTracer.cuh"
#include "Cuda/ImageJob.h"
#include "Cuda/LineChunk.cuh"

#include <memory>
#include <optional>
#include <utility>

namespace sono {

/// Where the tracer's results lie on the device.
struct TracedOnDevice
{
  const float* intensity = nullptr;       ///< lines x bins; null: 1 everywhere
  const float* attenuation = nullptr;     ///< lines x bins: B, Np of amplitude per MHz; null: not known
  const float* depthOffset = nullptr;     ///< lines x bins: TracedLines::depthOffsetMm; null: range is depth
  const float* reverberation = nullptr;   ///< lines x bins, by range; null: nothing does
  const float* reverberationNp = nullptr; ///< the same: its B
  int binCount = 0;
  float binMm = 1.0f;
  const EchoSum* echoSums = nullptr; ///< lines x echoCount x (re, im), on the RF's samples
  int echoCount = 0;
  float echoPerUnit = 0.0f;
  const float2* echo = nullptr; ///< or lines x rangeCount amplitudes
};

struct SurfaceGroup;
struct PieceList;
class DevicePieces;

/// Surfaces: pieces of boundaries, or points of targets.
struct SurfaceSet
{
  SurfaceTable table;
  const SurfaceGroup* groups;
  int groupCount;
  const SurfacePiece* pieces;
  const SurfacePoint* points;
  float longestStepMm; ///< between voxels
  float edgeMm;        ///< of a brick
  float marginMm;      ///< how far outside of its brick a piece may lie
  int media;
  PieceNets nets;
  std::uint64_t seed; ///< of the points' phases
};

struct SplatLaunch;

/// Forms RF lines on the device. Kept between jobs: a scene's tissues, explicit scatterers and fields.
class DeviceEcho
{
public:
  DeviceEcho();
  /// Nothing that it was asked for may still be going on.
  ~DeviceEcho();
  /// Uploads.
  void prepare(const EchoJob& job, cudaStream_t stream, Traffic& traffic);
  /// Then, before run(): the surfaces that the job's lines hear. The event is of after the uploads; waits for it, and
  /// for what is computed here, but not for what the stream was asked for since.
  void findPieces(const EchoJob& job, cudaEvent_t uploaded, Traffic& traffic);
  /// Forms the lines [first, first + count) of the job: their envelopes, and IQ where it is wanted.
  void run(int first, int count, const TracedOnDevice& traced, bool wantsIq, cudaStream_t stream);
  /// What the job gives in place of a tracer, for lines from `first` on; nothing of it where it gives none.
  TracedOnDevice given(int first) const;

  /// Hand over what run() has just made, lines x samples.
  DeviceArray<float2> takeIq() { return std::move(iq_); }
  DeviceArray<float> takeEnvelope() { return std::move(envelope_); }
  int sampleCount() const { return sampleCount_; }

private:
  /// What beams see of one kind of scatterers, which lie in bricks.
  struct Sight
  {
    BeamSightView view{}; ///< of a field
    DeviceArray<std::uint8_t> seen;
    DeviceArray<BeamPiece> pieces; ///< of each chunk
  };
  /// A group of them.
  struct Targets
  {
    SurfaceSet set{};
    DeviceArray<SurfacePoint> points;
    DeviceArray<SurfaceGroup> groups;
    Sight sight;                     ///< of a field
    DeviceArray<ComplexWeight> taps; ///< of its ring; empty: it does not
    int stride = 1;
    int lead = 0;
  };
  void uploadCarrier(const EchoJob& job, cudaStream_t stream, Traffic& traffic);
  void drawSpeckle(const EchoJob& job, cudaStream_t stream, Traffic& traffic);
  void uploadBeam(const BeamJob& job, cudaStream_t stream, Traffic& traffic);
  static void uploadFieldSight(const std::optional<SightJob>& job, Sight& sight, cudaStream_t stream, Traffic& traffic);
  void uploadSight(const std::optional<SightJob>& job, const std::vector<Beam>& beams, float brickMm, Sight& sight,
                   cudaStream_t stream, Traffic& traffic);
  /// What a launch for these beams holds.
  SplatLaunch splat(const Beam* beams, float scale, const Sight& sight) const;
  int chunks() const { return (sumCount_ + chunkSamples - 1) / chunkSamples; }
  void splatTissues(int first, int count, const TracedOnDevice& traced, cudaStream_t stream);
  void splatPoints(int first, int count, cudaStream_t stream);
  void uploadVoxels(const VoxelJob& job, cudaStream_t stream, Traffic& traffic);
  void uploadNested(const EchoJob& echo, cudaStream_t stream, Traffic& traffic);
  void uploadSurfaces(const EchoJob& echo, cudaStream_t stream, Traffic& traffic);
  void splatNested(int first, int count, const TracedOnDevice& traced, cudaStream_t stream);
  void splatSurfaces(int first, int count, const TracedOnDevice& traced, cudaStream_t stream);

  int sampleCount_ = 0;
  int sumCount_ = 0;
  int rangeCount_ = 0;
  int half_ = 0;
  double sampleMm_ = 0.0;
  LineGrid grid_{};
  BeamKind kind_ = BeamKind::Gaussian;
  std::optional<BeamReachTable> reach_;
  Vec2f sigmas_{ 1.0f }; ///< of all Gaussian beams
  bool complexPulse_ = false;
  DeviceArray<float> pulse_; ///< re, then im
  DeviceArray<float2> carrier_;
  double carrierRadPerSample_ = 0.0; ///< of that carrier
  DeviceArray<float> level_;
  int linesPerImage_ = 0;
  ReverberationNoise noise_;
  std::vector<float> reverberationRms_;
  std::vector<float> pulseRe_, pulseIm_;
  DeviceArray<float2> reverberationSpeckle_; ///< of these: linesPerImage x sampleCount
  std::optional<Downshift> downshift_;
  BeamFieldView field_{};
  SharedVector<float> fieldSource_;
  DeviceArray<float> fieldValues_;
  ArrayBeamView array_{};
  ArraySightView arraySight_{};
  std::shared_ptr<const ArrayField> arraySource_;
  DeviceArray<float> arrayLateral_, arrayElevational_, sightLateral_, sightElevational_;

  DeviceArray<Beam> sceneBeams_;

  bool tissues_ = false;
  std::uint64_t sceneId_ = 0;
  DeviceArray<std::uint8_t> voxels_;
  DeviceArray<std::uint8_t> detail_; ///< empty: none
  DeviceArray<ScatteringMedium> media_;
  DeviceArray<NestedMedium> nestedMedia_;
  Sight tissueSight_;
  Vec3i size_{ 0 };
  Vec3f spacing_{ 1.0f };
  float cellMm_ = 1.0f;
  std::uint64_t seed_ = 0;
  float tissueScale_ = 1.0f;

  bool nested_ = false;
  std::uint64_t fibresSceneId_ = 0;
  DeviceArray<std::uint32_t> fibreWords_;
  FibreView fibres_{};
  DeviceArray<float> fibreScale_, perMm3_;
  DeviceArray<std::uint8_t> coarseEnough_;
  DensityView density_;
  std::vector<ScattererDensity::Range> nestedRanges_; ///< of each level in use
  std::vector<Sight> nestedSights_;                   ///< the same
  float nestedScale_ = 1.0f;

  bool surfaces_ = false;
  std::shared_ptr<DevicePieces> pieces_; ///< of the scene
  std::shared_ptr<const PieceList> heardPieces_;
  DeviceArray<SurfaceRow> surfaceRows_;
  DeviceArray<float> diffuseL_, diffuseE_;
  SurfaceSet pieceSet_{};
  std::vector<Targets> targets_;
  Sight pieceSight_; ///< of a field
  float surfaceScale_ = 1.0f;
  ZeroedSums<EchoSum> surfaceSum_;  ///< lines x sumCount x (re, im)
  DeviceArray<EchoSum> ringingSum_; ///< the same of targets that ring, without what rings

  bool points_ = false;
  std::shared_ptr<const PointTable> table_;
  DeviceArray<float> x_, y_, z_, amplitude_;
  DeviceArray<int> begin_;
  DeviceArray<Beam> pointBeams_;
  Sight pointSight_;
  float pointScale_ = 1.0f;

  DeviceArray<float> givenIntensity_, givenAttenuation_, givenDepthOffset_, givenReverberation_, givenReverberationNp_;
  DeviceArray<float2> givenEcho_;
  TracedOnDevice given_;

  DeviceArray<float2> sum_;   ///< lines x sumCount, without nested scatterers
  ZeroedSums<int> nestedSum_; ///< lines x sumCount x (re, im), in units of 1 / nestedScale_
  DeviceArray<float> turns_;  ///< lines x rangeCount: of the downshift's phase
  DeviceArray<float2> iq_;
  DeviceArray<float> envelope_;
};

} // namespace sono
