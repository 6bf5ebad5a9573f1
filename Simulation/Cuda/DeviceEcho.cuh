#pragma once

#include "Cuda/DeviceMemory.cuh"
#include "Cuda/DeviceTracer.cuh"
#include "Cuda/ImageJob.h"
#include "Cuda/LineChunk.cuh"

#include <optional>
#include <utility>

namespace sono {

/// Where the tracer's results lie on the device.
struct TracedOnDevice
{
  const float* intensity = nullptr;   ///< lines x bins; null: 1 everywhere
  const float* attenuation = nullptr; ///< lines x bins: B, Np of amplitude per MHz; null: not known
  int binCount = 0;
  float binMm = 0.0f;
  const EchoSum* echoSums = nullptr; ///< lines x echoCount x (re, im), on the RF's samples
  int echoCount = 0;
  float echoPerUnit = 0.0f;
  const float2* echo = nullptr; ///< or lines x sumCount amplitudes
};

struct SplatLaunch;

/// Forms RF lines on the device. Kept between jobs: a scene's tissues, explicit scatterers and fields.
class DeviceEcho
{
public:
  void prepare(const EchoJob& job, cudaStream_t stream, Traffic& traffic);
  /// Forms the lines [first, first + count) of the job: their envelopes, and IQ where it is wanted.
  void run(int first, int count, const TracedOnDevice& traced, bool wantsIq, cudaStream_t stream);
  /// What the job gives in place of a tracer, for lines from `first` on; nothing of it where it gives none.
  TracedOnDevice given(int first) const;

  /// Hand over what run() has just made, lines x samples.
  DeviceArray<float2> takeIq() { return std::move(iq_); }
  DeviceArray<float> takeEnvelope() { return std::move(envelope_); }
  int sampleCount() const { return sampleCount_; }

private:
  /// Where the field matters to one kind of scatterers.
  struct Sight
  {
    BeamSightView view{};
    DeviceArray<std::uint8_t> seen;
    float lateralMm = 0.0f;
    float elevationalMm = 0.0f;
    bool some = false;
    void upload(const std::optional<SightJob>& job, cudaStream_t stream, Traffic& traffic);
  };
  void uploadCarrier(const EchoJob& job, cudaStream_t stream, Traffic& traffic);
  void setBeams(const std::vector<Beam>& beams);
  Vec2f ellipse(const Sight& sight) const;
  /// What a launch for these beams holds.
  SplatLaunch splat(const Beam* beams, float scale, const Sight& sight) const;
  int chunks() const { return (sumCount_ + chunkSamples - 1) / chunkSamples; }
  void splatTissues(int first, int count, const TracedOnDevice& traced, cudaStream_t stream);
  void splatPoints(int first, int count, cudaStream_t stream);

  int sampleCount_ = 0;
  int sumCount_ = 0;
  int half_ = 0;
  double sampleMm_ = 0.0;
  LineGrid grid_{};
  Vec2f sigmas_{ 1.0f }; ///< of all Gaussian beams
  bool complexPulse_ = false;
  DeviceArray<float> pulse_; ///< re, then im
  DeviceArray<float2> carrier_;
  double carrierRadPerSample_ = 0.0; ///< of that carrier
  DeviceArray<float> level_;
  std::optional<BeamFieldView> field_;
  SharedVector<float> fieldSource_;
  DeviceArray<float> fieldValues_;

  bool tissues_ = false;
  std::uint64_t sceneId_ = 0;
  DeviceArray<std::uint8_t> voxels_;
  DeviceArray<Beam> sceneBeams_;
  DeviceArray<ScatteringMedium> media_;
  Sight tissueSight_;
  Vec3i size_{ 0 };
  Vec3f spacing_{ 1.0f };
  float cellMm_ = 1.0f;
  std::uint64_t seed_ = 0;
  float tissueScale_ = 1.0f;

  bool points_ = false;
  std::shared_ptr<const PointTable> table_;
  DeviceArray<float> x_, y_, z_, amplitude_;
  DeviceArray<int> begin_;
  DeviceArray<Beam> pointBeams_;
  Sight pointSight_;
  float pointScale_ = 1.0f;

  DeviceArray<float> givenIntensity_;
  DeviceArray<float2> givenEcho_;
  TracedOnDevice given_;

  DeviceArray<float2> sum_; ///< lines x sumCount
  DeviceArray<float2> iq_;
  DeviceArray<float> envelope_;
};

} // namespace sono
