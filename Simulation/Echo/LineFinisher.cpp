#include "Echo/LineFinisher.h"
#include "Core/SoundSpeed.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr float darkIntensity = 1e-8f; // -160 dB

bool isWorthItsNoise(float level)
{
  return level > faintestReverberation;
}

} // namespace

LineFinisher::LineFinisher(const EchoSettings& settings, InterfaceModel model, const TracedLines* traced,
                           const FieldLevel* level, ReverberationSpeckle speckle)
  : traced_(traced)
  , samples_(settings.sampleCount())
  , sampleMm_(settings.sampleMm())
  , radPerMm_(4.0 * pi * settings.centreFrequencyMHz / assumedSoundSpeedMmPerUs)
  , pulse_(settings)
  , rangeCount_(samples_ + pulse_.half())
  , sumCount_(std::size_t(rangeCount_))
  , carrier_(radPerMm_ * sampleMm_, std::size_t(rangeCount_))
  , binsPerSample_(traced ? sampleMm_ / traced->binMm : 0.0)
  , speckle_(std::move(speckle))
{
  if (model == InterfaceModel::Acoustic)
  {
    sumCount_ = std::size_t(std::ceil(double(sumCount_) * deepestPerRange));
  }
  if (traced && traced->model == InterfaceModel::Acoustic && !traced->attenuationNpPerMHz.empty())
  {
    downshift_ = pulseDownshift(settings);
  }
  for (int e = 0; traced && level && e < traced->echoCount; ++e)
  {
    boundaryLevel_.push_back(float(level->at(e * traced->echoSampleMm)));
  }
}

LineSum LineFinisher::emptySum() const
{
  return { std::vector<float>(2 * sumCount_, 0.0f), float(sampleMm_), radPerMm_ };
}

float LineFinisher::reachMm(int line) const
{
  const double deepest = double(sumCount_) * sampleMm_;
  if (!traced_)
  {
    return float(deepest);
  }
  const float* bins = traced_->intensity.data() + std::size_t(line) * std::size_t(traced_->binCount);
  int b = traced_->binCount;
  while (b > 0 && !(bins[b - 1] > darkIntensity))
  {
    --b;
  }
  // The last bin's intensity holds below it, for the pulse's half.
  return b == 0 ? 0.0f : float(std::min(deepest, b == traced_->binCount ? deepest : (b + 0.5) * traced_->binMm));
}

bool LineFinisher::hasBoundaryEchoes(int line) const
{
  const std::complex<float>* first = traced_->boundaryEcho.data() + std::size_t(line) * std::size_t(traced_->echoCount);
  return lastOther(reinterpret_cast<const float*>(first), 2 * traced_->echoCount) > 0;
}

/// Where nothing reverberates, nothing is spent on it.
bool LineFinisher::reverberates(int line) const
{
  if (traced_->reverberation.empty())
  {
    return false;
  }
  const auto bins = traced_->reverberation.begin() + std::ptrdiff_t(line) * traced_->binCount;
  return std::any_of(bins, bins + traced_->binCount, isWorthItsNoise);
}

bool LineFinisher::sinks(int line) const
{
  if (!downshift_)
  {
    return false;
  }
  const auto first = traced_->attenuationNpPerMHz.begin() + std::ptrdiff_t(line) * traced_->binCount;
  return std::any_of(first, first + traced_->binCount, [](float b) { return b > 0.0f; });
}

RangeMap LineFinisher::rangeMap(int line) const
{
  if (!traced_ || traced_->depthOffsetMm.empty())
  {
    return {};
  }
  return { traced_->depthOffsetMm.data() + std::size_t(line) * std::size_t(traced_->binCount), traced_->binCount,
           float(1.0 / traced_->binMm) };
}

ReverberationNodes LineFinisher::reverberationNodes() const
{
  if (!traced_ || std::none_of(traced_->reverberation.begin(), traced_->reverberation.end(), isWorthItsNoise))
  {
    return {};
  }
  return ReverberationNodes(speckle_, pulse_, traced_->lineCount, samples_);
}

/// Moves the boundary echoes from the tracer's grid to the RF samples, phases kept.
LineSum LineFinisher::boundaryEchoes(int line) const
{
  LineSum sum{ std::vector<float>(2 * std::size_t(rangeCount_), 0.0f), float(sampleMm_), radPerMm_ };
  const std::complex<float>* echo = traced_->boundaryEcho.data() + std::size_t(line) * std::size_t(traced_->echoCount);
  for (int e = 0; e < traced_->echoCount; ++e)
  {
    if (echo[e] == std::complex<float>{})
    {
      continue;
    }
    const std::complex<float> seen = boundaryLevel_.empty() ? echo[e] : echo[e] * boundaryLevel_[std::size_t(e)];
    const double position = e * traced_->echoSampleMm / sampleMm_;
    const int s = int(std::floor(position + 1e-6));
    const double fraction = position - s;
    if (fraction < 1e-6) // on a common grid, exactly the sample
    {
      if (s < sum.sampleCount())
      {
        sum.iq[2 * std::size_t(s)] += seen.real();
        sum.iq[2 * std::size_t(s) + 1] += seen.imag();
      }
      continue;
    }
    for (int i = 0; i < 2; ++i)
    {
      const double share = i == 0 ? 1.0 - fraction : fraction;
      if (s + i < sum.sampleCount())
      {
        const double phase = radPerMm_ * sampleMm_ * (fraction - i);
        const std::complex<float> v = seen * std::complex<float>(std::polar(share, -phase));
        sum.iq[2 * std::size_t(s + i)] += v.real();
        sum.iq[2 * std::size_t(s + i) + 1] += v.imag();
      }
    }
  }
  return sum;
}

SurfaceIntensity LineFinisher::intensity(int line) const
{
  if (!traced_)
  {
    return {};
  }
  return { traced_->intensity.data() + std::size_t(line) * std::size_t(traced_->binCount), traced_->binCount,
           float(1.0 / traced_->binMm) };
}

LineFinisher::Room LineFinisher::room() const
{
  Room room;
  for (std::vector<float>* values : { &room.tableByDepth, &room.depthRe, &room.depthIm })
  {
    *values = sampleRoom(sumCount_);
  }
  for (std::vector<float>* values : { &room.offset, &room.exponent, &room.table, &room.lateRe, &room.lateIm,
                                      &room.turnRe, &room.turnIm, &room.outRe, &room.outIm })
  {
    *values = sampleRoom(std::size_t(rangeCount_) + 1);
  }
  for (std::vector<float>* values : { &room.re, &room.im }) // nothing lies above the first sample
  {
    *values = sampleRoom(std::size_t(pulse_.half() + rangeCount_));
  }
  return room;
}

/// What has been reflected is as weak as a pulse is that has been attenuated on its own way; the little that its
/// frequency differs from that of what is heard directly does not show in the envelope.
const float* LineFinisher::reflectedNp(int line) const
{
  return downshift_ && !traced_->reverberation.empty() && !traced_->reverberationNpPerMHz.empty()
           ? traced_->reverberationNpPerMHz.data() + std::size_t(line) * std::size_t(traced_->binCount)
           : nullptr;
}

/// Adds the boundary echoes of paths to what is heard.
void LineFinisher::addReflected(int line, Room& room, const SamplePair& heard) const
{
  const SamplePair late{ room.lateRe.data(), room.lateIm.data() };
  addDemodulated(boundaryEchoes(line).iq.data(), carrier_, rangeCount_, late);
  if (const float* bins = reflectedNp(line))
  {
    binAtSamples(bins, traced_->binCount, binsPerSample_, rangeCount_, room.table.data());
    applySinkGain(*downshift_, room.table.data(), rangeCount_, late);
  }
  std::transform(late.re, late.re + rangeCount_, heard.re, heard.re, std::plus<float>());
  std::transform(late.im, late.im + rangeCount_, heard.im, heard.im, std::plus<float>());
  std::fill_n(late.re, rangeCount_, 0.0f);
  std::fill_n(late.im, rangeCount_, 0.0f);
}

/// Adds the speckle of what reverberates behind the pulse.
void LineFinisher::addReverberating(int line, const ReverberationNodes& nodes, Room& room,
                                    std::complex<float>* iq) const
{
  const float* bins = traced_->reverberation.data() + std::size_t(line) * std::size_t(traced_->binCount);
  const float* np = reflectedNp(line);
  room.levels.assign(bins, bins + traced_->binCount);
  for (std::size_t b = 0; np && b < room.levels.size(); ++b)
  {
    room.levels[b] *= downshiftGain(*downshift_, shiftingExponent(*downshift_, np[b]));
  }
  linearAtSamples(room.levels.data(), traced_->binCount, binsPerSample_, samples_, room.table.data());
  nodes.add(line, room.table.data(), samples_, iq);
}

int LineFinisher::heardDepths(int line, const LineSum* surfaces) const
{
  if (!traced_)
  {
    return int(sumCount_);
  }
  const float* bins = traced_->intensity.data() + std::size_t(line) * std::size_t(traced_->binCount);
  const int lit = lastOther(bins, traced_->binCount); // in between, intensities are straight to the next bin's middle
  const double ends = lit == traced_->binCount ? double(sumCount_) : std::ceil((lit + 0.5) / binsPerSample_);
  const int onSurfaces = surfaces ? (lastOther(surfaces->iq.data(), 2 * int(sumCount_)) + 1) / 2 : 0;
  return std::max({ 1, int(std::min(double(sumCount_), lit == 0 ? 0.0 : ends)), onSurfaces });
}

int LineFinisher::rangesOf(const RangeMap& map, int depths) const
{
  if (!map.offsetMm)
  {
    return std::min(depths, rangeCount_);
  }
  const double depthMm = depths * sampleMm_;
  const double binMm = traced_->binMm;
  int k = 0;
  while (k < map.bins && k * binMm + double(map.offsetMm[k]) < depthMm)
  {
    ++k;
  }
  return k == map.bins ? rangeCount_ : int(std::min(double(rangeCount_), std::ceil(k * binMm / sampleMm_) + 2.0));
}

void LineFinisher::finish(int line, const LineSum& sum, const LineSum* surfaces, const ReverberationNodes& nodes,
                          Room& room, std::complex<float>* iq) const
{
  const std::size_t firstBin = traced_ ? std::size_t(line) * std::size_t(traced_->binCount) : 0;
  const bool isReflected = traced_ && hasBoundaryEchoes(line);
  const RangeMap map = rangeMap(line);
  // What nothing is heard from is not gone through: half of a line that ends in the lung.
  const int depthCount = heardDepths(line, surfaces);
  const int heardCount = isReflected ? rangeCount_ : rangesOf(map, depthCount);
  const int half = pulse_.half();
  const int outCount = std::min(samples_, heardCount + half);
  const int turnCount = std::max(heardCount, outCount);
  const float* intensity = nullptr;
  if (traced_)
  {
    linearAtSamples(traced_->intensity.data() + firstBin, traced_->binCount, binsPerSample_, depthCount,
                    room.tableByDepth.data());
    intensity = room.tableByDepth.data();
  }
  const SamplePair byDepth{ room.depthRe.data(), room.depthIm.data() };
  scaleAndAdd(sum.iq.data(), intensity, surfaces ? surfaces->iq.data() : nullptr, depthCount, byDepth);
  const SamplePair heard{ room.re.data() + half, room.im.data() + half };
  const float* offset = nullptr;
  if (map.offsetMm)
  {
    offsetsAtSamples(map, float(sampleMm_), turnCount + 1, room.offset.data());
    offset = room.offset.data();
    showDepths(byDepth, depthCount, offset, carrier_, heardCount, heard, room.far);
  }
  else
  {
    const int shown = std::min(heardCount, depthCount);
    demodulate(byDepth, carrier_, shown, heard);
    std::fill(heard.re + shown, heard.re + heardCount, 0.0f);
    std::fill(heard.im + shown, heard.im + heardCount, 0.0f);
  }
  const bool isSinking = sinks(line);
  if (isSinking)
  {
    const int deepest = turnCount + (offset ? int(std::ceil(offset[turnCount - 1])) : 0);
    const int npCount = std::clamp(deepest + 1, 1, int(sumCount_));
    linearAtSamples(traced_->attenuationNpPerMHz.data() + firstBin, traced_->binCount, binsPerSample_, npCount,
                    room.tableByDepth.data());
    exponentsAtSamples(*downshift_, room.tableByDepth.data(), npCount, offset, turnCount, room.exponent.data());
    applySinkGain(*downshift_, room.exponent.data(), heardCount, heard);
  }
  if (isReflected)
  {
    addReflected(line, room, heard);
  }
  const SamplePair turns{ room.turnRe.data(), room.turnIm.data() };
  if (isSinking)
  {
    downshiftRotations(*downshift_, room.exponent.data(), turnCount, turns);
    rotate(turns.re, turns.im, heardCount, heard);
  }
  const int silentEnd = std::min(rangeCount_, outCount + half); // that is what the pulse reaches
  for (float* values : { heard.re, heard.im })
  {
    std::fill(values + heardCount, values + silentEnd, 0.0f);
  }
  pulse_.convolve(room.re.data(), room.im.data(), outCount, { room.outRe.data(), room.outIm.data() });
  if (isSinking)
  {
    rotateBack(room.outRe.data(), room.outIm.data(), turns.re, turns.im, outCount, iq);
  }
  else
  {
    interleave(room.outRe.data(), room.outIm.data(), outCount, iq);
  }
  std::fill(iq + outCount, iq + samples_, std::complex<float>{});
  if (traced_ && reverberates(line))
  {
    addReverberating(line, nodes, room, iq);
  }
}

} // namespace sono
