#include "PeerScenes.h"

#include "Core/Device.h"
#include "Core/Version.h"
#include "Labels/CsvFile.h"
#include "SimulateChannels.h"

#include <sys/resource.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>

namespace sono::study {
namespace {

constexpr const char* us = "SonoVDB";
constexpr const char* processor = "CPU"; ///< how tables name it; other devices are GPUs

/// A program's time and error on a scene, with a setting.
struct Measured
{
  std::string program;
  std::string scene;
  std::string setting;
  double seconds;     ///< by the wall
  double coreSeconds; ///< of all cores, which other programs on the machine hardly touch
  double error;
  std::string device;
};

double coreSeconds()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * double(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
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
  const std::filesystem::path folder = named ? named : dataFile("../build/peers");
  const std::filesystem::path own = folder / "bin" / "python";
  const char* machines = "/usr/bin/python3"; // Debian's, which has python3-numpy
  return std::filesystem::exists(own) ? own.string() : std::filesystem::exists(machines) ? machines : "python3";
}

void runScript(const Output& output, const std::string& option)
{
  const std::string script = dataFile("../Testing/Study/peers/measure.py");
  const std::string command = "env -u PYTHONPATH -u PYTHONHOME PYTHONDONTWRITEBYTECODE=1 '" + python() + "' '" +
                              script + "' '" + output.file("").string() + "' " + option;
  if (std::system(command.c_str()) != 0)
  {
    throw Error("'" + script +
                "' failed, which measures the programs of others; it needs Python 3 with NumPy (python3-numpy)");
  }
}

std::shared_ptr<const SampledPulse> pulseOf(const Output& output, const PeerScene& scene)
{
  return std::make_shared<const SampledPulse>(readPulse(output.file("peers_pulse_" + scene.name + ".csv").string()));
}

/// Our signals go into a file that the same script compares with the reference as it compares theirs. They end in the
/// host's memory on either device.
Measured measureOurs(const Output& output, PeerScene scene, Device device, double& firstSeconds)
{
  scene.settings.device = device;
  const auto pulse = pulseOf(output, scene);
  std::vector<double> wall;
  std::vector<double> core;
  ChannelData data;
  for (int run = 0; run < (output.quick() ? 2 : 8); ++run)
  {
    const double coreBefore = coreSeconds();
    const auto start = std::chrono::steady_clock::now();
    data = simulateChannels(scene.plan(pulse), scene.points);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (run == 0)
    {
      firstSeconds = seconds;
      continue;
    }
    wall.push_back(seconds);
    core.push_back(coreSeconds() - coreBefore);
  }
  const std::string suffix = device == Device::Cuda ? "_cuda.f32" : "_cpu.f32";
  std::ofstream file(output.file("peers_ours_" + scene.name + suffix), std::ios::binary);
  file.write(reinterpret_cast<const char*>(data.rf.data()), std::streamsize(data.rf.size() * sizeof(float)));
  return { us, scene.name, "as it is", median(wall), median(core), 0.0, "" };
}

/// What counts: on the CPU core seconds, which other programs on the machine hardly touch; on a GPU the wall, since no
/// core is busy.
double cost(const Measured& measured)
{
  return measured.device == processor ? measured.coreSeconds : measured.seconds;
}

/// What each peer takes at equal error, on one device: of its settings the fastest that is no further off than we are,
/// or than it ever comes where that is more. Where none comes so near, the ratio is what it is at least.
void compare(Output& output, const std::vector<Measured>& measured)
{
  std::map<std::string, std::vector<Measured>> programs;
  for (const Measured& one : measured)
  {
    if (one.program != us)
    {
      programs[one.program + "_" + one.scene + (one.device == processor ? "" : "_gpu")].push_back(one);
    }
  }
  std::vector<std::vector<std::string>> rows;
  for (const auto& [key, runs] : programs)
  {
    const auto ours = std::find_if(measured.begin(), measured.end(), [&, &runs = runs](const Measured& m) {
      return m.program == us && m.scene == runs.front().scene && m.device == runs.front().device;
    });
    if (ours == measured.end())
    {
      continue; // theirs found a GPU that ours can't use
    }
    const auto best =
      std::min_element(runs.begin(), runs.end(), [](const auto& a, const auto& b) { return a.error < b.error; });
    const double allowed = std::max(ours->error, 1.02 * best->error);
    const Measured* equal = nullptr;
    const Measured* fastest = &runs.front();
    for (const Measured& run : runs)
    {
      fastest = cost(run) < cost(*fastest) ? &run : fastest;
      if (run.error <= allowed && (!equal || cost(run) < cost(*equal)))
      {
        equal = &run;
      }
    }
    const bool byCores = ours->device == processor;
    const double ratio = equal->seconds / ours->seconds;
    const double coreRatio = equal->coreSeconds / ours->coreSeconds;
    std::string name = key;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return c == '-' ? '_' : char(std::tolower(c)); });
    output.figure("peer_" + name + "_time_ratio", ratio, "1");
    if (byCores)
    {
      output.figure("peer_" + name + "_core_time_ratio", coreRatio, "1");
    }
    rows.push_back({ runs.front().program, ours->scene, ours->device, byCores ? "core seconds" : "the wall",
                     equal->setting, number(equal->error), number(ours->error), number(ratio),
                     byCores ? number(coreRatio) : "", fastest->setting, number(fastest->error),
                     number(cost(*fastest) / cost(*ours)) });
  }
  output.table("peers_equal.csv",
               { "program", "scene", "device", "compared by", "its setting at equal error", "its error", "our error",
                 "its time to ours", "its core seconds to ours", "its fastest setting", "error of that",
                 "that to ours, as compared" },
               rows);
}

void peers(Output& output)
{
  const std::vector<PeerScene> scenes = peerScenes(output.quick());
  writePeerScenes(output, scenes);
  runScript(output, output.quick() ? "--quick" : "");
  const CsvFile theirs = CsvFile::read(output.file("peers_theirs.csv").string());
  std::vector<Measured> measured;
  std::vector<double> firstSeconds;
  for (const PeerScene& scene : scenes)
  {
    if (!std::filesystem::exists(output.file("peers_pulse_" + scene.name + ".csv")))
    {
      continue;
    }
    measured.push_back(measureOurs(output, scene, Device::Cpu, firstSeconds.emplace_back()));
    if (chooseDevice(Device::Auto).cuda)
    {
      measured.push_back(measureOurs(output, scene, Device::Cuda, firstSeconds.emplace_back()));
    }
  }
  runScript(output, "--ours");
  const CsvFile errors = CsvFile::read(output.file("peers_ours.csv").string());
  std::vector<std::vector<std::string>> rows;
  for (std::size_t n = 0; n < errors.rows.size(); ++n)
  {
    Measured& ours = measured[n];
    ours.error = std::stod(errors.rows[n].fields[1]);
    ours.device = errors.rows[n].fields[2];
    rows.push_back({ ours.scene, us, version(), ours.setting, number(ours.seconds), number(ours.coreSeconds),
                     number(firstSeconds[n]), number(ours.error), ours.device });
  }
  for (const CsvFile::Row& row : theirs.rows)
  {
    rows.push_back(row.fields);
    const double error = std::strtod(row.fields[7].c_str(), nullptr);
    if (error > 0.0)
    {
      measured.push_back({ row.fields[1], row.fields[0], row.fields[3], std::stod(row.fields[4]),
                           std::stod(row.fields[5]), error, row.fields[8] });
    }
  }
  output.table("peers.csv", theirs.header, rows);
  compare(output, measured);
}

const Part part("peers", peers);

} // namespace
} // namespace sono::study
