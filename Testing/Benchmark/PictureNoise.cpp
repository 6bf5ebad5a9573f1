#include "PictureNoise.h"

#include "ApicalImage.h"

#include "Trace/Trace.h"

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

} // namespace

PictureNoise::PictureNoise(const Scene& scene, const ImageSettings& settings)
  : scene_(scene)
  , settings_(settings)
  , lines_(a4cLines(settings))
{
  const std::vector<float> envelope = image(40000, 77).envelope();
  std::vector<float> sorted = envelope;
  const auto bright = sorted.begin() + std::ptrdiff_t(sorted.size() - sorted.size() / 200);
  std::nth_element(sorted.begin(), bright, sorted.end());
  zeroDb_ = double(*bright);
  reference_ = decibelsOf(envelope, zeroDb_);
}

RfLines PictureNoise::image(int paths, std::uint64_t seed) const
{
  TraceSettings tracing = settings_.tracing;
  tracing.pathsPerLine = paths;
  tracing.seed = seed;
  return formRf(scene_, lines_, trace(scene_, lines_, tracing), settings_.echo);
}

double PictureNoise::decibels(int paths) const
{
  double squares = 0.0;
  long count = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
  {
    const std::vector<float> db = decibelsOf(image(paths, seed).envelope(), zeroDb_);
    for (std::size_t i = 0; i < db.size(); ++i)
    {
      if (std::max(db[i], reference_[i]) > float(floorDb))
      {
        squares += std::pow(double(db[i]) - double(reference_[i]), 2);
        ++count;
      }
    }
  }
  return std::sqrt(squares / double(std::max(1l, count)));
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

} // namespace sono
