#include "ErrorText.h"
#include "Folders.h"
#include "Probe/ArrayBeam.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <vector>

using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;

namespace {

constexpr double pi = 3.141592653589793;
constexpr double none = std::numeric_limits<double>::infinity();

/// 64 elements without gaps, 19.2 mm wide: F/3.125 at 60 mm. So low that its elevation does not matter.
ArrayAperture rectangularAperture()
{
  ArrayAperture aperture;
  aperture.elementCount = 64;
  aperture.elementWidthMm = 0.3;
  aperture.kerfMm = 0.0;
  aperture.elementHeightMm = 0.5;
  aperture.transmitFocusMm = 60.0;
  aperture.elevationFocusMm = none;
  aperture.centreFrequencyMHz = 3.6;
  return aperture;
}

FieldGrid lineAcross(double depthMm, double stepMm, int count)
{
  return { { 0.0, stepMm, count }, { 0.0, 1.0, 1 }, { depthMm, 1.0, 1 } };
}

/// Full width where the half profile falls to half of its first value.
double widthMm(const std::vector<float>& half, double stepMm)
{
  for (std::size_t i = 1; i < half.size(); ++i)
  {
    const double level = 0.5 * half[0];
    if (half[i] <= level)
    {
      return 2.0 * stepMm * (double(i) - (level - half[i]) / (half[i - 1] - half[i]));
    }
  }
  return none;
}

double decibels(double ratio)
{
  return 20.0 * std::log10(ratio);
}

/// The largest side lobe, dB to the main one; `first` is past the main lobe's zero.
double highestSideLobeDb(const std::vector<float>& half, int first)
{
  return decibels(*std::max_element(half.begin() + first, half.end()) / half[0]);
}

/// Rayleigh's integral in a rigid baffle, by brute force: p = k / (2 pi) |sum of w exp(i k (r - d)) exp(-a r) dA / r|
/// over the aperture's surface in pieces of a fifteenth of a wavelength.
double rayleigh(const ArrayAperture& aperture, double frequencyMHz, double focusMm, double x, double y, double z)
{
  const double k = 2.0 * pi * frequencyMHz / aperture.soundSpeedMmPerUs;
  const double nepers = aperture.attenuationDbPerCmMHz * frequencyMHz / 10.0 / (20.0 / std::log(10.0));
  const double finest = aperture.soundSpeedMmPerUs / frequencyMHz / 15.0;
  const int across = int(std::ceil(aperture.elementWidthMm / finest));
  const int along = int(std::ceil(aperture.elementHeightMm / finest));
  std::complex<double> sum;
  for (int n = 0; n < aperture.elementCount; ++n)
  {
    const double centre = (n - 0.5 * (aperture.elementCount - 1)) * (aperture.elementWidthMm + aperture.kerfMm);
    const double delay = std::isinf(focusMm) ? 0.0 : std::hypot(centre, focusMm);
    for (int i = 0; i < across; ++i)
    {
      const double px = centre + aperture.elementWidthMm * ((i + 0.5) / across - 0.5);
      for (int j = 0; j < along; ++j)
      {
        const double py = aperture.elementHeightMm * ((j + 0.5) / along - 0.5);
        const double lens = std::isinf(aperture.elevationFocusMm) ? 0.0 : std::hypot(py, aperture.elevationFocusMm);
        const double r = std::sqrt((x - px) * (x - px) + (y - py) * (y - py) + z * z);
        sum += std::polar(std::exp(-nepers * r) / r, k * (r - delay - lens));
      }
    }
  }
  const double area = aperture.elementWidthMm / across * aperture.elementHeightMm / along;
  return aperture.centreFrequencyMHz / aperture.soundSpeedMmPerUs * area * std::abs(sum);
}

} // namespace

TEST(ArrayBeam, WidthAtTheFocusIsThatOfARectangularAperture)
{
  const ArrayAperture aperture = rectangularAperture();
  const double lambdaF = aperture.wavelengthMm() * 60.0 / 19.2;
  const double step = 0.01;
  const FieldGrid grid = lineAcross(60.0, step, 1000);
  const auto oneWay = transmitField(aperture, grid);
  const auto twoWay = pulseEchoField(aperture, grid).values();
  EXPECT_NEAR(widthMm(oneWay, step) / lambdaF, 1.207, 0.03 * 1.207);
  EXPECT_NEAR(widthMm(twoWay, step) / lambdaF, 0.886, 0.03 * 0.886);
  // sinc^2 with its first zero at lambda F#, over the main lobe and the first side lobe
  double worst = 0.0;
  for (double x = 0.0; x < 1.8 * lambdaF; x += step)
  {
    const double u = pi * x / lambdaF;
    const double sinc = u == 0.0 ? 1.0 : std::sin(u) / u;
    worst = std::max(worst, std::abs(twoWay[std::size_t(std::lround(x / step))] - sinc * sinc));
  }
  EXPECT_LT(worst, 0.01);
  const auto first = twoWay.begin() + std::lround(0.7 * lambdaF / step);
  const auto zero = std::min_element(first, twoWay.begin() + std::lround(1.3 * lambdaF / step));
  EXPECT_NEAR(double(zero - twoWay.begin()) * step / lambdaF, 1.0, 0.02);
}

TEST(ArrayBeam, ReceptionFocusesAtEveryDepth)
{
  ArrayAperture aperture = rectangularAperture();
  for (const double depthMm : { 40.0, 90.0 })
  {
    // Away from the transmit focus, p_tx p_rx with p_rx from an aperture that is focused at this depth.
    ArrayAperture receiver = aperture;
    receiver.transmitFocusMm = depthMm;
    const FieldGrid grid = lineAcross(depthMm, 0.05, 100);
    const auto transmit = transmitField(aperture, grid);
    const auto receive = transmitField(receiver, grid);
    const auto twoWay = pulseEchoField(aperture, grid).values();
    std::vector<float> product;
    std::transform(transmit.begin(), transmit.end(), receive.begin(), std::back_inserter(product), std::multiplies<>());
    const float largest = *std::max_element(product.begin(), product.end());
    for (std::size_t i = 0; i < product.size(); ++i)
    {
      ASSERT_NEAR(twoWay[i], product[i] / largest, 1e-6) << depthMm << " " << i;
    }
  }
}

TEST(ArrayBeam, HannLowersTheSideLobes)
{
  // At F/15, where the focal plane holds the aperture's Fourier transform; F/3 adds half a decibel to Hann's lobe.
  ArrayAperture aperture = rectangularAperture();
  aperture.transmitFocusMm = 15.0 * 19.2;
  const double lambdaF = aperture.wavelengthMm() * 15.0;
  const double step = 0.05;
  const FieldGrid grid = lineAcross(aperture.transmitFocusMm, step, 600);
  const auto boxcar = transmitField(aperture, grid);
  aperture.apodization = Apodization::Hann;
  const auto hann = transmitField(aperture, grid);
  // Far-field closed forms: -13.26 dB and, with the zero at 2 lambda F#, -31.47 dB.
  EXPECT_NEAR(highestSideLobeDb(boxcar, int(lambdaF / step)), -13.26, 0.1);
  EXPECT_NEAR(highestSideLobeDb(hann, int(2.0 * lambdaF / step)), -31.47, 0.1);
  EXPECT_NEAR(widthMm(hann, step) / lambdaF, 2.0, 0.02);
}

TEST(ArrayBeam, UnfocusedSlabOnItsAxis)
{
  ArrayAperture aperture = rectangularAperture();
  aperture.elementHeightMm = 2.0;
  aperture.transmitFocusMm = none;
  const FieldGrid grid{ { 0.0, 1.0, 1 }, { 0.0, 1.0, 1 }, { 2.0, 4.7, 30 } };
  const auto axis = transmitField(aperture, grid);
  for (int n = 0; n < grid.depth.count; ++n)
  {
    const double exact = rayleigh(aperture, 3.6, none, 0.0, 0.0, grid.depth.at(n));
    EXPECT_NEAR(axis[std::size_t(n)] / exact, 1.0, 5e-3) << grid.depth.at(n);
  }
}

TEST(ArrayBeam, FocusedBeamEverywhere)
{
  ArrayAperture aperture; // of the P4-2 class, with a lens and gaps
  aperture.elevationFocusMm = 70.0;
  aperture.attenuationDbPerCmMHz = 0.3;
  const FieldGrid grid{ { -4.0, 2.0, 5 }, { -3.0, 3.0, 3 }, { 12.0, 29.0, 4 } };
  const auto field = transmitField(aperture, grid);
  std::size_t n = 0;
  for (int d = 0; d < grid.depth.count; ++d)
  {
    std::vector<double> exact;
    for (int e = 0; e < grid.elevational.count; ++e)
    {
      for (int l = 0; l < grid.lateral.count; ++l)
      {
        exact.push_back(rayleigh(aperture, 3.6, 65.0, grid.lateral.at(l), grid.elevational.at(e), grid.depth.at(d)));
      }
    }
    const double largest = *std::max_element(exact.begin(), exact.end());
    for (const double p : exact)
    {
      EXPECT_NEAR(field[n], p, 0.01 * largest) << "at " << n << ", depth " << grid.depth.at(d);
      ++n;
    }
  }
}

TEST(ArrayBeam, FarFieldOfOneElementIsASinc)
{
  ArrayAperture aperture = rectangularAperture();
  aperture.elementCount = 1;
  aperture.elementWidthMm = 2.0 * aperture.wavelengthMm();
  aperture.transmitFocusMm = none;
  const double depthMm = 400.0;
  const FieldGrid grid = lineAcross(depthMm, 2.0, 300);
  const auto field = transmitField(aperture, grid);
  for (int i = 0; i < grid.lateral.count; ++i)
  {
    const double r = std::hypot(grid.lateral.at(i), depthMm);
    const double u = pi * 2.0 * grid.lateral.at(i) / r;
    const double sinc = u == 0.0 ? 1.0 : std::sin(u) / u;
    ASSERT_NEAR(field[std::size_t(i)] * r / (field[0] * depthMm), std::abs(sinc), 2e-3) << i;
  }
}

TEST(ArrayBeam, ElevationFocus)
{
  ArrayAperture aperture;
  aperture.elementHeightMm = 14.0;
  aperture.elevationFocusMm = 60.0;
  aperture.transmitFocusMm = 60.0;
  const double step = 0.02;
  const FieldGrid grid{ { 0.0, 1.0, 1 }, { 0.0, step, 300 }, { 60.0, 1.0, 1 } };
  const double lambdaF = aperture.wavelengthMm() * 60.0 / 14.0;
  EXPECT_NEAR(widthMm(transmitField(aperture, grid), step) / lambdaF, 1.207, 0.03 * 1.207);
  EXPECT_NEAR(widthMm(pulseEchoField(aperture, grid).values(), step) / lambdaF, 0.886, 0.03 * 0.886);
}

TEST(ArrayBeam, ConvexFaceFocusesAllElements)
{
  // At the focus every element arrives in phase: the sum of their amplitudes by hand, for elements that are small.
  ArrayAperture aperture = rectangularAperture();
  aperture.elementCount = 40;
  aperture.elementWidthMm = 0.1;
  aperture.kerfMm = 0.4;
  aperture.elementHeightMm = 0.1;
  aperture.faceRadiusMm = 50.0;
  aperture.transmitFocusMm = 70.0;
  double sum = 0.0;
  for (int n = 0; n < 40; ++n)
  {
    const double angle = (n - 19.5) * 0.5 / 50.0;
    const double dx = 50.0 * std::sin(angle);
    const double dz = 70.0 + 50.0 * (1.0 - std::cos(angle));
    const double r = std::hypot(dx, dz);
    const double sine = std::sin(angle + std::atan2(dx, dz));
    const double u = pi * 0.1 / aperture.wavelengthMm() * sine;
    sum += 0.01 * (std::abs(u) < 1e-9 ? 1.0 : std::sin(u) / u) / r / aperture.wavelengthMm();
  }
  EXPECT_NEAR(transmitField(aperture, lineAcross(70.0, 1.0, 1))[0] / sum, 1.0, 1e-4);
}

TEST(ArrayBeam, FullTableIsTheMirroredHalf)
{
  const ArrayAperture aperture;
  const FieldGrid half{ { 0.0, 0.7, 9 }, { 0.0, 0.9, 5 }, { 20.0, 25.0, 3 } };
  const FieldGrid full{ { -5.6, 0.7, 17 }, { -3.6, 0.9, 9 }, { 20.0, 25.0, 3 } };
  const PulseEchoField a = pulseEchoField(aperture, half);
  const PulseEchoField b = pulseEchoField(aperture, full);
  for (double l = -5.5; l < 5.6; l += 0.37)
  {
    for (double e = -3.5; e < 3.6; e += 0.41)
    {
      const float one = beamWeight(a.view(), float(l), float(e), 37.0f);
      EXPECT_NEAR(one, beamWeight(b.view(), float(l), float(e), 37.0f), 2e-5);
      EXPECT_EQ(one, beamWeight(a.view(), float(-l), float(-e), 37.0f));
    }
  }
}

TEST(ArrayBeam, AttenuationFallsAlongTheAxis)
{
  ArrayAperture aperture = rectangularAperture();
  aperture.elementCount = 4; // so narrow that all paths are as long as the axis
  const FieldGrid grid{ { 0.0, 1.0, 1 }, { 0.0, 1.0, 1 }, { 10.0, 10.0, 16 } };
  const auto lossless = transmitField(aperture, grid);
  aperture.attenuationDbPerCmMHz = 0.5;
  const auto lossy = transmitField(aperture, grid);
  for (int n = 0; n < grid.depth.count; ++n)
  {
    const double lossDb = 0.5 * 3.6 * grid.depth.at(n) / 10.0;
    EXPECT_NEAR(decibels(lossy[std::size_t(n)] / lossless[std::size_t(n)]), -lossDb, 0.02);
  }
}

TEST(ArrayBeam, BandwidthAveragesThePower)
{
  ArrayAperture aperture = rectangularAperture();
  const FieldGrid grid = lineAcross(60.0, 0.1, 60);
  std::vector<double> squares(60, 0.0);
  double sum = 0.0;
  for (int tone = -2; tone <= 2; ++tone)
  {
    // amplitude of the Gaussian: a half at 3.6 (1 +- 0.35), so 2^(-(2 tone / 5)^2)
    const double power = std::pow(2.0, -2.0 * std::pow(0.4 * tone, 2));
    ArrayAperture single = aperture;
    single.centreFrequencyMHz = 3.6 * (1.0 + 0.35 * 0.4 * tone);
    const auto field = transmitField(single, grid);
    for (std::size_t i = 0; i < squares.size(); ++i)
    {
      // 1 / wavelength is of the centre frequency in a broadband field
      const double amplitude = field[i] * 3.6 / single.centreFrequencyMHz;
      squares[i] += power * amplitude * amplitude;
    }
    sum += power;
  }
  aperture.fractionalBandwidth = 0.7;
  const auto broadband = transmitField(aperture, grid);
  for (std::size_t i = 0; i < squares.size(); ++i)
  {
    EXPECT_NEAR(broadband[i], std::sqrt(squares[i] / sum), 2e-3 * broadband[0]) << i;
  }
}

TEST(ArrayBeam, PresetsGiveSensibleBeams)
{
  for (const char* file : { "phased_p4-2", "linear_l14", "curvilinear_c5-2" })
  {
    const ProbePreset preset = readProbePreset(dataFile(std::string("probes/") + file + ".json"));
    const ArrayAperture aperture = apertureOf(preset);
    FieldGrid grid = suggestedFieldGrid(aperture, preset.geometry.depthMm);
    EXPECT_EQ(grid.size(), 64u * 32u * 128u);
    grid.depth = { 0.0, preset.geometry.depthMm / 31.0, 32 };
    const PulseEchoField field = pulseEchoField(aperture, grid);
    const auto brightest = std::max_element(field.values().begin(), field.values().end()) - field.values().begin();
    const double depthMm = grid.depth.at(int(std::size_t(brightest) / (64 * 32)));
    EXPECT_EQ(brightest % (64 * 32), 0) << file; // on the axis
    EXPECT_GT(depthMm, 0.5 * std::min(preset.transmitFocusMm, preset.elevationFocusMm)) << file;
    EXPECT_LT(depthMm, 1.2 * std::max(preset.transmitFocusMm, preset.elevationFocusMm)) << file;
    for (const float value : field.values())
    {
      ASSERT_TRUE(std::isfinite(value)) << file;
    }
  }
}

TEST(ArrayBeam, DoesNotDependOnTheNumberOfThreads)
{
  const ArrayAperture aperture;
  const FieldGrid grid{ { 0.0, 0.5, 20 }, { 0.0, 0.5, 10 }, { 0.0, 5.0, 20 } };
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return pulseEchoField(aperture, grid).values();
  };
  EXPECT_EQ(run(1), run(4));
}

TEST(ArrayBeam, StopsWhenAsked)
{
  const FieldGrid grid{ { 0.0, 0.5, 20 }, { 0.0, 0.5, 10 }, { 0.0, 1.0, 100 } };
  EXPECT_THROW(pulseEchoField(ArrayAperture(), grid, [](double) { return false; }), Aborted);
  double last = 0.0;
  pulseEchoField(ArrayAperture(), grid, [&](double fraction) { return last = std::max(last, fraction), true; });
  EXPECT_GT(last, 0.5);
}

TEST(ArrayBeam, AperturesCompare)
{
  ArrayAperture a, b;
  EXPECT_TRUE(a == b);
  b.attenuationDbPerCmMHz = 0.1;
  EXPECT_FALSE(a == b);
}

TEST(ArrayBeam, ErrorsNameTheParameter)
{
  const auto refusal = [](const std::function<void(ArrayAperture&)>& change) {
    ArrayAperture aperture;
    change(aperture);
    return errorOf([&] { transmitField(aperture, lineAcross(50.0, 1.0, 2)); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expectContains(refusal([](auto& a) { a.elementCount = 0; }), "elementCount is 0");
  expectContains(refusal([](auto& a) { a.elementWidthMm = -1.0; }), "elementWidthMm is -1");
  expectContains(refusal([nan](auto& a) { a.kerfMm = nan; }), "kerfMm");
  expectContains(refusal([](auto& a) { a.elementHeightMm = 1000.0; }), "1000 wavelengths");
  expectContains(refusal([](auto& a) { a.kerfMm = 100.0; }), "aperture's width");
  expectContains(refusal([](auto& a) { a.transmitFocusMm = 0.0; }), "transmitFocusMm is 0");
  expectContains(refusal([nan](auto& a) { a.elevationFocusMm = nan; }), "elevationFocusMm");
  expectContains(refusal([](auto& a) { a.centreFrequencyMHz = 0.0; }), "centreFrequencyMHz is 0");
  expectContains(refusal([](auto& a) { a.fractionalBandwidth = 2.0; }), "fractionalBandwidth is 2");
  expectContains(refusal([](auto& a) { a.faceRadiusMm = 2.0; }), "faceRadiusMm is 2");
  expectContains(refusal([](auto& a) { a.attenuationDbPerCmMHz = -0.5; }), "attenuationDbPerCmMHz is -0.5");
  const FieldGrid dense{ { 0.0, 1.0, 1 }, { 0.0, 1e-5, 2000000 }, { 10.0, 1.0, 1 } };
  expectContains(errorOf([&] { transmitField(ArrayAperture(), dense); }), "elevational axis");
  ArrayAperture deaf;
  deaf.attenuationDbPerCmMHz = 100.0;
  expectContains(errorOf([&] { pulseEchoField(deaf, lineAcross(1000.0, 1.0, 2)); }), "zero everywhere");
}
