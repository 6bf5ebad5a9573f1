#include "PictureNoise.h"

#include "ApicalImage.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr double floorDb = -60.0;

std::vector<float> decibelsOf(const std::vector<float>& envelope, double zeroDb)
{
  std::vector<float> db(envelope.size());
  std::transform(envelope.begin(), envelope.end(), db.begin(), [&](float value) {
    return float(std::max(floorDb, 20.0 * std::log10(double(value) / zeroDb + 1e-12)));
  });
  return db;
}

/// What one of 200 samples exceeds.
double zeroOf(std::vector<float> envelope)
{
  const auto bright = envelope.begin() + std::ptrdiff_t(envelope.size() - envelope.size() / 200);
  std::nth_element(envelope.begin(), bright, envelope.end());
  return double(*bright);
}

/// Sums of squared differences.
struct Differences
{
  double squares = 0.0;
  long count = 0;

  void add(float db, float reference)
  {
    if (std::max(db, reference) > float(floorDb))
    {
      squares += std::pow(double(db) - double(reference), 2);
      ++count;
    }
  }
  double rms() const { return std::sqrt(squares / double(std::max(1l, count))); }
};

} // namespace

PictureNoise::PictureNoise(const Scene& scene, const ImageSettings& settings)
  : scene_(scene)
  , settings_(settings)
  , lines_(a4cLines(settings))
{
  TraceSettings tracing = settings.tracing;
  tracing.pathsPerLine = 40000;
  tracing.seed = 77;
  const TracedLines traced = trace(scene, lines_, tracing);
  for (std::uint64_t seed = 1; seed <= seeds; ++seed)
  {
    const std::vector<float> reference = envelope(traced, seed);
    zeroDb_.push_back(zeroOf(reference));
    reference_.push_back(decibelsOf(reference, zeroDb_.back()));
  }
}

std::vector<float> PictureNoise::envelope(const TracedLines& traced, std::uint64_t seed) const
{
  EchoSettings echo = settings_.echo;
  echo.seed = seed;
  return formRf(scene_, lines_, traced, echo).envelope();
}

double PictureNoise::decibels(int paths) const
{
  Differences all;
  TraceSettings tracing = settings_.tracing;
  tracing.pathsPerLine = paths;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed)
  {
    tracing.seed = seed;
    const std::size_t n = std::size_t(seed - 1);
    const std::vector<float> db = decibelsOf(envelope(trace(scene_, lines_, tracing), seed), zeroDb_[n]);
    for (std::size_t i = 0; i < db.size(); ++i)
    {
      all.add(db[i], reference_[n][i]);
    }
  }
  return all.rms();
}

int PictureNoise::pathsWithin(double db) const
{
  double before = 0.0;
  double beforeDb = 0.0;
  for (double paths = 16.0;; paths *= std::sqrt(2.0))
  {
    const double here = decibels(int(std::lround(paths)));
    if (here <= db || paths > 1e5)
    {
      const double share = before > 0.0 ? std::log(beforeDb / db) / std::log(beforeDb / here) : 1.0;
      return int(std::ceil(paths * std::pow(std::sqrt(2.0), share - 1.0)));
    }
    before = paths;
    beforeDb = here;
  }
}

double PictureNoise::samplingDb(const Scene& scene, const ImageSettings& settings)
{
  constexpr int finer = 10;
  const std::vector<ScanLine> lines = a4cLines(settings);
  const auto imageOf = [&](double samplingMHz) {
    ImageSettings one = settings;
    one.tracing.reverberation = false;
    one.echo.samplingMHz = samplingMHz;
    one.matchStages();
    return formRf(scene, lines, trace(scene, lines, one.tracing), one.echo);
  };
  const double samplingMHz = settings.echo.samplingInMHz();
  const RfLines fine = imageOf(finer * samplingMHz);
  const RfLines usual = imageOf(samplingMHz);
  const std::vector<float> envelope = fine.envelope();
  const double zeroDb = zeroOf(envelope);
  const std::vector<float> reference = decibelsOf(envelope, zeroDb);
  const std::vector<float> db = decibelsOf(usual.envelope(), zeroDb);
  Differences all;
  for (int line = 0; line < usual.lineCount; ++line)
  {
    for (int s = 0; s < usual.sampleCount && finer * s < fine.sampleCount; ++s)
    {
      all.add(db[std::size_t(line) * std::size_t(usual.sampleCount) + std::size_t(s)],
              reference[std::size_t(line) * std::size_t(fine.sampleCount) + std::size_t(finer * s)]);
    }
  }
  return all.rms();
}

} // namespace sono
