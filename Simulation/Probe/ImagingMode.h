#pragma once

namespace sono {

/// What of the sound that comes back makes the picture.
enum class ImagingMode
{
  Fundamental, ///< what was sent
  Harmonic ///< the second harmonic that grows on the way, at twice the frequency (Data/docs/physics.md section 14.2)
};

/// Centre frequency of what a probe that sends `sentMHz` receives, MHz; and back.
constexpr double receivedMHz(ImagingMode mode, double sentMHz)
{
  return mode == ImagingMode::Harmonic ? 2.0 * sentMHz : sentMHz;
}
constexpr double sentMHz(ImagingMode mode, double receivedMHz)
{
  return mode == ImagingMode::Harmonic ? 0.5 * receivedMHz : receivedMHz;
}

/// Fractional bandwidth of what is received. The harmonic's pulse is the square of the Gaussian that was sent: root of
/// 2 times the band, at twice the frequency.
constexpr double receivedBandwidth(ImagingMode mode, double fractionalBandwidth)
{
  constexpr double perRoot2 = 0.70710678118654752;
  return mode == ImagingMode::Harmonic ? perRoot2 * fractionalBandwidth : fractionalBandwidth;
}

} // namespace sono
