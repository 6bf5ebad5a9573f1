#pragma once

#include "Echo/PointTable.h"
#include "Echo/RodRing.h"
#include "Echo/ScattererDensity.h"
#include "Image/Haze.h"
#include "Kernel/BeamSight.h"
#include "Kernel/Downshift.h"
#include "Kernel/EchoSplat.h"
#include "Kernel/GreyLevel.h"
#include "Kernel/LabelRow.h"
#include "Kernel/PlaneScan.h"
#include "Kernel/ReverberationNoise.h"
#include "Kernel/Scatterer.h"
#include "Kernel/SurfacePiece.h"
#include "Kernel/TraceView.h"
#include "Probe/ArrayField.h"
#include "Scene/FibreField.h"
#include "Scene/SurfacePieces.h"
#include "Scene/TraceRegion.h"
#include "Trace/TargetBvh.h"

#include <array>
#include <complex>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace sono {

/// Data that is shared, not copied.
template<class T>
using SharedVector = std::shared_ptr<const std::vector<T>>;

/// Tracing as a device needs it: numbers only. Lines of all images stand one after the other; those of one image are
/// numbered from 0 for their random numbers, so that an image does not depend on the others of its batch.
struct TraceJob
{
  TraceView view;                 ///< its `media` are those below
  std::vector<TraceMedium> media; ///< at most 65536
  std::vector<TraceLine> lines;
  int linesPerImage = 1;
  std::vector<std::uint64_t> seeds;          ///< of the paths of each image
  std::shared_ptr<const TraceRegion> region; ///< kept on the device while it is the same
  int bakedBlocks = 0;                       ///< of its records: they go up again when there are more
  TargetBvh targets;
  int paths = 0; ///< of a line
  int binCount = 0;
  float binMm = 0.0f;
  double frequencyMHz = 1.0;
  bool rangeIsTime = false;
  int echoCount = 0; ///< 0: boundaries do not echo
  float echoSampleMm = 0.0f;
  float radPerMm = 0.0f; ///< 2 k of the boundary echoes' phases
};

/// What the harmonic of two traces of the same lines grows by (Trace/SecondHarmonic.h).
struct HarmonicJob
{
  std::vector<float> sourcesPerMm;         ///< lines x bins
  std::vector<std::complex<double>> gains; ///< bins
};

/// A field in place of a Gaussian beam.
struct FieldJob
{
  BeamFieldView view;         ///< its `values` are those below
  SharedVector<float> values; ///< kept on the device while they are the same
};

/// What all lines' beams have in common. Those of the scatterers below hold no pointers to tables.
struct BeamJob
{
  BeamKind kind = BeamKind::Gaussian;
  std::optional<FieldJob> field;
  std::shared_ptr<const ArrayField> array; ///< kept on the device while it is the same
  std::optional<BeamReachTable> reach;     ///< of an Aperture or Array
  double largestWeight = 1.0;              ///< bounds over all depths: of |W|, and of its integral across the beam
  double largestAreaMm2 = 1.0;
};

/// What lies in a brick, of an array sorted by brick.
struct BrickRange
{
  int first;
  int count;
};

/// Where a field matters to bricks of `brickMm`.
struct SightJob
{
  BeamSightView view; ///< its `seen` is the one below
  std::vector<std::uint8_t> seen;
  float lateralMm = 0.0f; ///< furthest distance of a seen brick's centre from the axis
  float elevationalMm = 0.0f;
};

/// A scene's voxels, kept on the device while it is the same; the scene must outlive the job.
struct VoxelJob
{
  const std::vector<std::uint8_t>* tissues = nullptr;
  const std::vector<std::uint8_t>* detail = nullptr; ///< empty where there is none
  std::uint64_t sceneId = 0;
  Vec3i size{ 0 };
  Vec3f spacing{ 1.0f };
};

/// Procedural scatterers of a volume of tissues.
struct TissueJob
{
  VoxelJob voxels;
  std::array<ScatteringMedium, 256> media{};
  float cellMm = 0.5f;
  std::uint64_t seed = 1;
  std::optional<SightJob> sight;
};

/// Nested scatterers of a volume of tissues (see NestedScatterers).
struct NestedJob
{
  VoxelJob voxels;
  std::array<NestedMedium, 256> media{};
  std::array<float, 256> fibreScale{}; ///< amplitude times exp(-(fibreScale fibre . axis)^2); 0: no fibres
  const FibreField* fibres = nullptr;  ///< of the scene, kept as its voxels are; null: none
  std::uint64_t seed = 1;
  DensityView density; ///< its tables are those below
  std::vector<float> perMm3;
  std::vector<std::uint8_t> coarseEnough;
  std::vector<ScattererDensity::Range> ranges; ///< depths of each level, from the finest on
  std::vector<SightJob> sights;                ///< of each level, where there is a field
};

/// The surfaces of targets as points, sorted by brick.
struct TargetPointJob
{
  /// Points [first, end).
  struct Brick
  {
    Vec3f centreMm;
    int first;
    int end;
  };

  std::vector<SurfacePoint> points;
  std::vector<Brick> bricks; ///< those with points, of those that a beam may see
  float edgeMm = 1.0f;
  std::optional<SightJob> sight;
  RodRing ring;
};

/// Echoes of the boundaries between labels and of targets (see SurfaceEchoes).
struct SurfaceJob
{
  VoxelJob voxels;
  const SurfacePieces* pieces = nullptr; ///< belong to the scene, which the job must not outlive
  std::vector<int> blocks;               ///< of theirs, that a beam may see
  float longestStepMm = 0.0f;            ///< between voxels
  PieceNets nets{};
  std::uint64_t seed = 1;
  int media = 0;
  SurfaceTable pieceTable; ///< its tables are those below, and those of the targets' are the same
  SurfaceTable targetTable;
  std::vector<SurfaceRow> rows;
  std::vector<float> diffuseL;
  std::vector<float> diffuseE;
  std::optional<SightJob> sight;       ///< of the pieces' bricks
  std::vector<TargetPointJob> targets; ///< groups, see SurfaceEchoes
};

/// Explicit scatterers, sorted by brick (see PointScatterers).
struct PointJob
{
  std::vector<Beam> beams;                 ///< mm from the scatterers' own origin
  std::shared_ptr<const PointTable> table; ///< kept on the device while it is the same
  std::optional<SightJob> sight;
};

/// Traced lines that are not traced by the same job.
struct GivenTrace
{
  std::vector<float> intensity;           ///< lines x bins
  std::vector<float> attenuationNpPerMHz; ///< the same; empty: not known
  std::vector<float> depthOffsetMm;       ///< the same; empty: range is depth
  std::vector<float> reverberation;       ///< the same; empty: nothing does
  std::vector<float> reverberationNpPerMHz;
  int binCount = 0;
  float binMm = 0.0f;
  std::vector<std::complex<float>> boundaryEcho; ///< lines x rangeCount, on the RF's samples; empty: none
};

/// Image formation as a device needs it.
struct EchoJob
{
  int lineCount = 0;
  int sampleCount = 0;
  int sumCount = 0;   ///< samples of the sum by depth, see LineFinisher
  int rangeCount = 0; ///< samples by range before the pulse: half a pulse more
  double sampleMm = 0.0;
  double radPerMm = 0.0;
  std::vector<float> pulseRe;         ///< envelope, from its end to its start
  std::vector<float> pulseIm;         ///< empty where it would be zero
  std::optional<Downshift> downshift; ///< nothing where attenuation leaves the frequency alone
  std::vector<float> boundaryLevel;   ///< of each sample; empty: 1
  int linesPerImage = 1;              ///< those of the reverberation's noise
  ReverberationNoise noise;
  std::vector<float> reverberationRms; ///< of each sample of range; empty: none
  BeamJob beam;
  std::vector<Beam> sceneBeams;       ///< of the lines, local mm of the scene's volume; empty without a scene
  std::optional<TissueJob> tissues;   ///< of Amadou2024
  std::optional<NestedJob> nested;    ///< of Acoustic
  std::optional<SurfaceJob> surfaces; ///< the same
  std::optional<PointJob> points;
  std::optional<GivenTrace> given; ///< when the job does not trace; without either, intensity 1 and no boundaries
};

/// B-mode as a device needs it, for each sample of a line.
struct BModeJob
{
  std::vector<float> gainFactor;       ///< for the automatic reference
  std::vector<double> gainDb;          ///< of depth, all other gain and the bottom of the range, without the reference
  std::vector<float> lateralGainDb;    ///< of each line of an image
  std::vector<float> greyMap;          ///< empty: linear
  std::vector<float> axialSmoothing;   ///< weights of 0, 1, ... samples away; empty: none
  std::vector<float> lateralSmoothing; ///< the same of lines
  bool smoothCompressed = false;       ///< the levels instead of the envelope
  int linesAcross = 1;                 ///< that lie in one plane
  HazePower haze;                      ///< of the lines of an image
  int firstReferenceSample = 0;        ///< of a line: the automatic reference leaves out what lies above
  bool automaticReference = true;
  double referenceAmplitude = 1.0;
  float rangeDb = 60.0f;
  float rejectDb = 0.0f;
  float noiseRms = 0.0f; ///< 0: none
  float noiseNodesPerSample = 0.0f;
  std::uint64_t noiseSeed = 1;
};

/// Rows of pixels through a label map, for all rows of an image, one image after the other.
struct LabelJob
{
  SharedVector<std::uint16_t> voxels; ///< belong to the scene where it made the job, which it must outlive
  std::uint64_t sceneId = 0;          ///< the voxels are kept on the device while it is the same
  Vec3i size{ 0 };
  std::vector<LabelRow> rows;
  PlaneScan scan{};                             ///< see offsetScan
  const std::vector<float>* offsetMm = nullptr; ///< depth offsets that do not lie on the device
};

} // namespace sono
