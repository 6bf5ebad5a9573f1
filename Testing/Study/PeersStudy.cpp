#include "PeerScenes.h"

#include "Core/Version.h"
#include "Labels/CsvFile.h"
#include "SimulateChannels.h"

#include <sys/resource.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>

namespace sono::study {
namespace {

constexpr const char* us = "SonoVDB";

/// A program's time and error on a scene, with a setting.
struct Measured
{
  std::string program;
  std::string scene;
  std::string setting;
  double seconds;     ///< by the wall
  double coreSeconds; ///< of all cores, which other programs on the machine hardly touch
  double error;
};

double userSeconds()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_utime.tv_sec) + 1e-6 * double(usage.ru_utime.tv_usec);
}

double median(std::vector<double> values)
{
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// The Python that has the programs of others, or the machine's.
std::string python()
{
  const char* named = std::getenv("SONOVDB_PEERS");
  const std::filesystem::path folder =
    named ? std::filesystem::path(named) : std::filesystem::path(SONOVDB_DATA_DIR) / ".." / "build" / "peers";
  const std::filesystem::path own = folder / "bin" / "python";
  return std::filesystem::exists(own) ? own.string() : "python3";
}

/// Runs peers/measure.py, which leaves peers_theirs.csv, and for each scene pulse and reference.
void measureTheirs(const Output& output)
{
  const auto script = std::filesystem::path(SONOVDB_DATA_DIR) / ".." / "Testing" / "Study" / "peers" / "measure.py";
  const std::string command = "env -u PYTHONPATH -u PYTHONHOME '" + python() + "' '" + script.string() + "' '" +
                              output.file("").string() + "'" + (output.quick() ? " --quick" : "");
  if (std::system(command.c_str()) != 0)
  {
    throw Error("'" + script.string() +
                "' failed, which measures the programs of others; it needs Python 3 with NumPy (python3-numpy)");
  }
}

std::shared_ptr<const SampledPulse> pulseOf(const Output& output, const PeerScene& scene)
{
  return std::make_shared<const SampledPulse>(readPulse(output.file("peers_pulse_" + scene.name + ".csv").string()));
}

/// The reference's signals, transmits x elements x samples, in doubles.
std::vector<double> referenceOf(const Output& output, const PeerScene& scene)
{
  const auto path = output.file("peers_reference_" + scene.name + ".f64");
  std::vector<double> values(std::filesystem::file_size(path) / sizeof(double));
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(values.data()), std::streamsize(values.size() * sizeof(double)));
  if (!file)
  {
    throw Error("'" + path.string() + "' cannot be read");
  }
  return values;
}

/// What is left of the signals less the reference after one factor for each transmit, as the peers have it; no delay is
/// fitted to ours.
double errorOf(const ChannelData& data, const std::vector<double>& reference)
{
  const std::size_t signals = std::size_t(data.transmitCount) * std::size_t(data.elementCount);
  const std::size_t given = reference.size() / signals;
  const std::size_t count = std::min(given, std::size_t(data.sampleCount));
  double left = 0.0;
  double all = 0.0;
  for (int t = 0; t < data.transmitCount; ++t)
  {
    double mixed = 0.0;
    double theirs = 0.0;
    double ours = 0.0;
    for (int n = 0; n < data.elementCount; ++n)
    {
      const float* signal = data.signal(t, n);
      const double* wanted =
        reference.data() + (std::size_t(t) * std::size_t(data.elementCount) + std::size_t(n)) * given;
      for (std::size_t s = 0; s < count; ++s)
      {
        mixed += double(signal[s]) * wanted[s];
        theirs += wanted[s] * wanted[s];
        ours += double(signal[s]) * double(signal[s]);
      }
    }
    const double factor = mixed / theirs;
    left += ours / (factor * factor) - theirs;
    all += theirs;
  }
  return std::sqrt(std::max(0.0, left) / all);
}

std::vector<std::string> measureOurs(const Output& output, const PeerScene& scene, std::vector<Measured>& measured)
{
  const auto pulse = pulseOf(output, scene);
  std::vector<double> wall;
  std::vector<double> user;
  double first = 0.0;
  ChannelData data;
  for (int run = 0; run < (output.quick() ? 2 : 8); ++run)
  {
    const double userBefore = userSeconds();
    const auto start = std::chrono::steady_clock::now();
    data = simulateChannels(scene.plan(pulse), scene.points);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (run == 0)
    {
      first = seconds;
      continue;
    }
    wall.push_back(seconds);
    user.push_back(userSeconds() - userBefore);
  }
  const double error = errorOf(data, referenceOf(output, scene));
  measured.push_back({ us, scene.name, "as it is", median(wall), median(user), error });
  return { scene.name,    us,   version(), "as it is", number(median(wall)), number(median(user)), number(first),
           number(error), "CPU" };
}

/// What each peer takes at equal error: of its settings the fastest that is no further off than we are, or than it ever
/// comes where that is more. Where none comes so near, the ratio is what it is at least.
void compare(Output& output, const std::vector<Measured>& measured)
{
  std::map<std::string, std::vector<Measured>> programs;
  for (const Measured& one : measured)
  {
    if (one.program != us)
    {
      programs[one.program + "_" + one.scene].push_back(one);
    }
  }
  std::vector<std::vector<std::string>> rows;
  for (const auto& [key, runs] : programs)
  {
    const auto ours = std::find_if(measured.begin(), measured.end(), [&, &runs = runs](const Measured& m) {
      return m.program == us && m.scene == runs.front().scene;
    });
    const auto best =
      std::min_element(runs.begin(), runs.end(), [](const auto& a, const auto& b) { return a.error < b.error; });
    const double allowed = std::max(ours->error, 1.02 * best->error);
    const Measured* equal = nullptr;
    const Measured* fastest = &runs.front();
    for (const Measured& run : runs)
    {
      fastest = run.coreSeconds < fastest->coreSeconds ? &run : fastest;
      if (run.error <= allowed && (!equal || run.coreSeconds < equal->coreSeconds))
      {
        equal = &run;
      }
    }
    const double ratio = equal->seconds / ours->seconds;
    const double coreRatio = equal->coreSeconds / ours->coreSeconds;
    std::string name = key;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return c == '-' ? '_' : char(std::tolower(c)); });
    output.figure("peer_" + name + "_time_ratio", ratio, "1");
    output.figure("peer_" + name + "_core_time_ratio", coreRatio, "1");
    rows.push_back({ runs.front().program, ours->scene, equal->setting, number(equal->error), number(ours->error),
                     number(ratio), number(coreRatio), fastest->setting, number(fastest->error),
                     number(fastest->coreSeconds / ours->coreSeconds) });
  }
  output.table("peers_equal.csv",
               { "program", "scene", "its setting at equal error", "its error", "our error", "its time to ours",
                 "its core seconds to ours", "its fastest setting", "error of that", "core seconds of that to ours" },
               rows);
}

void peers(Output& output)
{
  const std::vector<PeerScene> scenes = peerScenes(output.quick());
  writePeerScenes(output, scenes);
  measureTheirs(output);
  const CsvFile theirs = CsvFile::read(output.file("peers_theirs.csv").string());
  std::vector<std::vector<std::string>> rows;
  std::vector<Measured> measured;
  for (const PeerScene& scene : scenes)
  {
    if (std::filesystem::exists(output.file("peers_reference_" + scene.name + ".f64")))
    {
      rows.push_back(measureOurs(output, scene, measured));
    }
  }
  for (const CsvFile::Row& row : theirs.rows)
  {
    rows.push_back(row.fields);
    const double error = std::strtod(row.fields[7].c_str(), nullptr);
    if (error > 0.0)
    {
      measured.push_back(
        { row.fields[1], row.fields[0], row.fields[3], std::stod(row.fields[4]), std::stod(row.fields[5]), error });
    }
  }
  output.table("peers.csv", theirs.header, rows);
  compare(output, measured);
}

const Part part("peers", peers);

} // namespace
} // namespace sono::study
