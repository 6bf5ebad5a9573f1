#pragma once

#include "Core/Device.h"
#include "Core/Parameters.h"
#include "Probe/ArrayBeam.h"
#include "Probe/ScanGeometry.h"

#include <cstdint>

namespace sono {

/// What an array sends at once.
enum class TransmitKind
{
  PlaneWaves,
  DivergingWaves, ///< from a virtual source behind the face
  FocusedWaves
};

enum class Baffle
{
  Soft, ///< elements radiate by the cosine of the angle from their normal
  Rigid ///< evenly
};

/// How channel data are made; frequency, bandwidth, face, lens and depth are the probe's.
struct ChannelSettings
{
  TransmitKind transmitKind = TransmitKind::PlaneWaves;
  int transmitCount = 10;
  double transmitSpanDeg = 30.0;
  double transmitDistanceMm = 0.0; ///< 0: half the aperture (diverging), the probe's transmit focus (focused)
  Apodization apodization = Apodization::Boxcar;
  int elementCount = 64;           ///< 0: as many as stand side by side
  double channelSamplingMHz = 0.0; ///< 0: four times the centre frequency
  Baffle baffle = Baffle::Soft;
  bool flat = false;
  double attenuationDbPerCmMHz = 0.0; ///< of scatterers without anatomy
  int scatterersPerCell = 6;
  std::uint64_t seed = 1; ///< of the tissues' scatterers, as EchoSettings has it
  Device device = Device::Auto;

  template<class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor(self.transmitKind,
            Parameter{ "transmitKind",
                       "Transmit Kind",
                       {},
                       "What each transmit sends: a plane wave, a wave that diverges from a virtual source behind the "
                       "face, or one that is focused.",
                       { "Plane Waves", "Diverging Waves", "Focused Waves" } });
    visitor(self.transmitCount, Parameter{ "transmitCount", "Transmit Count", between(1, 1024),
                                           "Number of transmits, 1 to 1024, no unit." });
    visitor(self.transmitSpanDeg,
            Parameter{ "transmitSpanDeg", "Transmit Span (deg)", between(0, 160),
                       "Angle between the directions of the first and the last transmit in degrees, 0 to 160; those "
                       "between are evenly spaced, one alone goes straight ahead." });
    visitor(self.transmitDistanceMm,
            Parameter{ "transmitDistanceMm", "Transmit Distance (mm)", between(0, 10000),
                       "Distance of the virtual source behind the middle of the face, or of the focus before it, in "
                       "mm, 0 to 10,000; not for plane waves. 0: half the aperture's width, or the probe's transmit "
                       "focus." });
    visitor(self.apodization, Parameter{ "apodization",
                                         "Apodization",
                                         {},
                                         "Weights of the elements in transmit: all equal, or falling to the array's "
                                         "ends. What is received is not weighted.",
                                         { "Boxcar", "Hann" } });
    visitor(self.elementCount,
            Parameter{ "elementCount", "Element Count", between(0, 1024),
                       "Number of elements over the face, 0 to 1024, no unit. 0: as many as stand side by side." });
    visitor(self.channelSamplingMHz,
            Parameter{ "channelSamplingMHz", "Channel Sampling (MHz)", between(0, 1000),
                       "Sampling frequency of the channels in MHz, up to 1000 and more than twice the upper end of the "
                       "band. 0: four times the centre frequency." });
    visitor(self.baffle,
            Parameter{ "baffle",
                       "Baffle",
                       {},
                       "What the elements are set in: soft, where they radiate by the cosine of the angle from their "
                       "normal, or rigid, where they radiate evenly.",
                       { "Soft", "Rigid" } });
    visitor(self.flat, Parameter{ "flat",
                                  "Flat",
                                  {},
                                  "Elements are endlessly high, as in two dimensions: how far a scatterer lies from "
                                  "the image plane does not count, and its echo falls off less. For scatterers without "
                                  "anatomy." });
    visitor(self.attenuationDbPerCmMHz,
            Parameter{ "attenuationDbPerCmMHz", "Attenuation (dB per cm MHz)", between(0, 100),
                       "One-way attenuation in dB/(cm MHz), 0 to 100, of scatterers without anatomy; what lies in a "
                       "body has that of its tissues." });
    visitor(self.scatterersPerCell,
            Parameter{ "scatterersPerCell", "Scatterers per Cell", between(1, 15),
                       "Candidates for scatterers in a resolution cell of the probe's beam, 1 to 15, no unit. 6: as "
                       "many as the picture has; fewer take as much less time, each stronger." });
    visitor(self.seed,
            Parameter{ "scattererSeed", "Scatterer Seed", atLeast(0),
                       "Seed of the scatterers, at least 0, no unit: with that of the picture they are the same." });
    visitor(self.device, deviceParameter());
  }

  /// Throws Error naming the parameter and its range.
  void validate() const { requireInRange(*this); }
  double samplingFor(const ProbeSettings& probe) const
  {
    return channelSamplingMHz > 0.0 ? channelSamplingMHz : 4.0 * probe.centreFrequencyMHz;
  }
};

} // namespace sono
