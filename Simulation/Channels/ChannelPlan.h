#pragma once

#include "Channels/ChannelPoints.h"
#include "Channels/PulseSpectrum.h"
#include "Channels/Transmits.h"
#include "Core/Progress.h"
#include "Kernel/ChannelWave.h"

#include <complex>
#include <vector>

namespace sono {

/// One signal of each element for each transmit.
struct ChannelData
{
  int transmitCount = 0;
  int elementCount = 0;
  int sampleCount = 0;
  double samplingMHz = 0.0;
  std::vector<float> rf; ///< transmits x elements x samples; sample s is at time s / samplingMHz, see Transmits

  const float* signal(int transmit, int element) const
  {
    return rf.data() +
           (std::size_t(transmit) * std::size_t(elementCount) + std::size_t(element)) * std::size_t(sampleCount);
  }
};

/// An array's elements cut into pieces, for the loops: piece p of element n is number p * padded + n. Those that fill
/// up to whole vectors send and hear nothing.
struct ElementPieces
{
  std::vector<float> x, z, normalX, normalZ;
  int elements = 0;
  int padded = 0;
  int perElement = 1;
  float halfWidthMm = 0.0f; ///< of a piece
};

/// All that channels depend on besides what echoes.
struct ChannelPlan
{
  /// `pulse` may be null: the probe's Gaussian. `startUs` of the pulse counts from the echo. Throws Error naming what
  /// is out of range, too much, or of a probe that has no channels.
  ChannelPlan(const ChannelSettings& settings, const ProbeSettings& probe,
              std::shared_ptr<const SampledPulse> pulse = nullptr);

  ChannelSettings settings;
  ArrayElements elements;
  Transmits transmits;
  PulseSpectrum spectrum;
  ElementPieces pieces;
  ElementShape shape;
  float shortestMm; ///< half a wavelength
  float npPerMmMHz; ///< one-way attenuation of the amplitude
  double centreMHz; ///< of the pulse
  double samplingMHz;
  int sampleCount;
  double highMHz; ///< end of the band

  ChannelData described() const; ///< without signals
  ChannelData empty() const;     ///< signals of zeros
};

/// Points whose echoes arrive in one stretch of time, [first, end) of the sorted ones, and its first sample.
struct ChannelShell
{
  std::size_t first;
  std::size_t end;
  int firstSample;
};

/// How the channels are summed: shell by shell, each over the frequencies (firstBin + j) samplingMHz / samples, which
/// are so close together as the stretch is long (Data/docs/physics.md section 15.2).
struct ChannelShells
{
  ChannelPoints points; ///< sorted
  std::vector<ChannelShell> shells;
  int samples = 0; ///< of a stretch
  int firstBin = 0;
  int bins = 0;
  double stepMHz = 0.0;
  std::vector<std::complex<float>> pulse;  ///< of each frequency: twice the step times its spectrum, for both sides
  std::vector<float> turnCosine, turnSine; ///< of 2 pi n / samples

  double frequencyMHz(int bin) const { return (firstBin + bin) * stepMHz; }
};

/// Points behind the face and those that are heard after the last sample are left out.
ChannelShells makeShells(const ChannelPlan& plan, const ChannelPoints& points);

/// What elements send at each frequency: bins x transmits x (re of all elements, im of all elements), padded.
std::vector<float> driveTable(const ChannelPlan& plan, const ChannelShells& shells);

/// Adds a shell to the signals. Its sums, bins x transmits x (re, im of padded elements), are of what elements hear at
/// unit pulse.
void synthesise(const ChannelPlan& plan, const ChannelShells& shells, const ChannelShell& shell,
                const std::vector<float>& sums, ChannelData& data);

/// Sums of a shell on the CPU.
void sumShell(const ChannelPlan& plan, const ChannelShells& shells, const ChannelShell& shell,
              const std::vector<float>& drive, const Progress& progress, std::vector<float>& sums);

/// All of it on the CPU; the result depends on the arguments alone, to the bit, not on the threads. Throws Aborted.
ChannelData formChannels(const ChannelPlan& plan, const ChannelPoints& points, const Progress& progress = {});

} // namespace sono
