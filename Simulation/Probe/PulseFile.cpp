#include "Probe/PulseFile.h"

#include "Core/Error.h"
#include "Core/SoundSpeed.h"
#include "Labels/CsvFile.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr std::size_t fewest = 4;
constexpr std::size_t most = 8192;
constexpr double evenness = 0.01;   // of a step
constexpr double cutLevel = 1e-5;   // of the peak
constexpr double bandLoss = 1e-3;   // of the root mean square
constexpr double negligible = 1e-9; // of the strongest tone
constexpr int peakSearch = 8;       // evaluations a step

using Complex = std::complex<double>;

double number(const CsvFile& file, const CsvFile::Row& row, int column)
{
  const std::string& text = row.fields[std::size_t(column)];
  const auto value = parseNumber(text);
  if (!value || !std::isfinite(*value))
  {
    throw Error(file.where(row) + ": '" + text + "' is no finite number; write one under '" +
                file.header[std::size_t(column)] + "'.");
  }
  return *value;
}

/// exp(i 2 pi frequencyMHz t) of the analytic signal, with its amplitude.
struct Tone
{
  double frequencyMHz;
  Complex amplitude;
};

/// The analytic signal as a Fourier sum. Zeros as long as the pulse keep its period from wrapping into it.
std::vector<Tone> analyticTones(const SampledPulse& pulse)
{
  const std::size_t count = pulse.amplitude.size();
  const std::size_t period = 2 * count;
  std::vector<Tone> tones;
  double strongest = 0.0;
  for (std::size_t k = 0; k <= count; ++k)
  {
    const double frequency = double(k) / (double(period) * pulse.stepUs);
    const Complex turn = std::polar(1.0, -2.0 * pi * double(k) / double(period));
    Complex phase = 1.0;
    Complex sum = 0.0;
    for (std::size_t n = 0; n < count; ++n)
    {
      sum += pulse.amplitude[n] * phase;
      phase *= turn;
    }
    const double weight = (k == 0 || k == count ? 1.0 : 2.0) / double(period);
    tones.push_back({ frequency, weight * sum * std::polar(1.0, -2.0 * pi * frequency * pulse.startUs) });
    strongest = std::max(strongest, std::abs(tones.back().amplitude));
  }
  tones.erase(std::remove_if(tones.begin(), tones.end(),
                             [&](const Tone& tone) { return std::abs(tone.amplitude) < negligible * strongest; }),
              tones.end());
  return tones;
}

void requireBand(const std::vector<Tone>& tones, double stepUs)
{
  double all = 0.0;
  double outside = 0.0;
  for (const Tone& tone : tones)
  {
    all += std::norm(tone.amplitude);
    outside += std::abs(tone.frequencyMHz) > 0.5 / stepUs ? std::norm(tone.amplitude) : 0.0;
  }
  if (outside > bandLoss * bandLoss * all)
  {
    std::ostringstream message;
    message
      << "the sampled pulse reaches beyond " << 0.5 / stepUs
      << " MHz from the centre frequency, which is all that the samples carry; correct the centre frequency or the "
         "pulse's times (microseconds), or raise Sampling (MHz).";
    throw Error(message.str());
  }
}

Complex valueAt(const std::vector<Tone>& tones, double timeUs)
{
  Complex sum = 0.0;
  for (const Tone& tone : tones)
  {
    sum += tone.amplitude * std::polar(1.0, 2.0 * pi * tone.frequencyMHz * timeUs);
  }
  return sum;
}

void require(const char* parameter, double value, bool good, const char* range)
{
  if (!good)
  {
    std::ostringstream message;
    message << parameter << " is " << value << "; choose " << range << ".";
    throw Error(message.str());
  }
}

double sinc(double x)
{
  return std::abs(x) < 1e-6 ? 1.0 : std::sin(x) / x;
}

} // namespace

SampledPulse readPulse(const std::string& path)
{
  const CsvFile file = CsvFile::read(path);
  const int time = file.requiredColumn("time_us");
  const int amplitude = file.requiredColumn("amplitude");
  const std::size_t count = file.rows.size();
  if (count < fewest || count > most)
  {
    throw Error("'" + path + "' holds " + std::to_string(count) + " samples; a pulse has " + std::to_string(fewest) +
                " to " + std::to_string(most) + ".");
  }
  std::vector<double> timesUs;
  SampledPulse pulse;
  for (const CsvFile::Row& row : file.rows)
  {
    const double timeUs = number(file, row, time);
    if (!timesUs.empty() && timeUs <= timesUs.back())
    {
      throw Error(file.where(row) + ": the time does not ascend; order the samples by time_us.");
    }
    timesUs.push_back(timeUs);
    pulse.amplitude.push_back(number(file, row, amplitude));
  }
  pulse.startUs = timesUs.front();
  pulse.stepUs = (timesUs.back() - pulse.startUs) / double(count - 1);
  for (std::size_t n = 0; n < count; ++n)
  {
    if (std::abs(timesUs[n] - (pulse.startUs + double(n) * pulse.stepUs)) > evenness * pulse.stepUs)
    {
      throw Error(file.where(file.rows[n]) + ": the times are not evenly spaced; resample the pulse to one step.");
    }
  }
  if (std::all_of(pulse.amplitude.begin(), pulse.amplitude.end(), [](double a) { return a == 0.0; }))
  {
    throw Error("'" + path + "' holds no pulse: all amplitudes are zero; write the echo of a point.");
  }
  return pulse;
}

std::vector<std::complex<float>> pulseBaseband(const SampledPulse& pulse, double centreFrequencyMHz, double sampleMm,
                                               double splitMm)
{
  require("the centre frequency (MHz)", centreFrequencyMHz,
          centreFrequencyMHz > 0.0 && std::isfinite(centreFrequencyMHz), "more than 0");
  require("sampleMm", sampleMm, sampleMm > 0.0 && std::isfinite(sampleMm), "more than 0");
  require("splitMm", splitMm, splitMm >= 0.0 && splitMm <= sampleMm, "0 to sampleMm");
  const double stepUs = 2.0 * sampleMm / assumedSoundSpeedMmPerUs;
  const double splitUs = 2.0 * splitMm / assumedSoundSpeedMmPerUs;
  std::vector<Tone> tones = analyticTones(pulse);
  for (Tone& tone : tones)
  {
    tone.frequencyMHz -= centreFrequencyMHz;
  }
  requireBand(tones, stepUs);

  const double endUs = pulse.startUs + pulse.stepUs * double(pulse.amplitude.size() - 1);
  const double reach = std::ceil(std::max(std::abs(pulse.startUs), std::abs(endUs)) / stepUs);
  require("the pulse's length in samples", 2.0 * reach + 1.0, reach <= double(most),
          "a shorter pulse, nearer to time 0, or longer sampling steps");
  double peak = 0.0;
  for (int n = -int(reach) * peakSearch; n <= int(reach) * peakSearch; ++n)
  {
    peak = std::max(peak, std::abs(valueAt(tones, n * stepUs / peakSearch)));
  }
  for (Tone& tone : tones)
  {
    const double loss = sinc(pi * tone.frequencyMHz * splitUs);
    tone.amplitude /= peak * loss * loss;
  }
  int half = 0;
  std::vector<Complex> after{ valueAt(tones, 0.0) };
  std::vector<Complex> before{ after[0] };
  for (int n = 1; n <= int(reach); ++n)
  {
    after.push_back(valueAt(tones, n * stepUs));
    before.push_back(valueAt(tones, -n * stepUs));
    half = std::max(std::abs(after.back()), std::abs(before.back())) > cutLevel ? n : half;
  }
  std::vector<std::complex<float>> envelope;
  for (int n = -half; n <= half; ++n)
  {
    envelope.push_back(std::complex<float>(n < 0 ? before[std::size_t(-n)] : after[std::size_t(n)]));
  }
  return envelope;
}

} // namespace sono
