// WriteGpuJobs FOLDER: the workloads of GpuBenchmark, each with what the CPU makes of it.
#include "Cuda/MakeImageJob.h"
#include "Cuda/RunOnDevice.h"
#include "Echo/EchoSetup.h"
#include "EchoScenes.h"
#include "JobFile.h"
#include "PhantomScene.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Simulate.h"

#include <cmath>
#include <cstdio>
#include <exception>

namespace {

using namespace sono;

constexpr int poseCount = 64;

/// The apical view, and from it a sweep: the probe tilts to and fro by 15 degrees and turns by 20.
std::vector<ProbePose> sweep()
{
  const ProbePose start = thoraxPhantomA4C().orthonormalized();
  std::vector<ProbePose> poses;
  for (int i = 0; i < poseCount; ++i)
  {
    const double tilt = 0.26 * std::sin(2.0 * M_PI * i / poseCount);
    const double turn = 0.35 * i / poseCount;
    const Vec3d elevation = glm::cross(start.axial, start.lateral);
    ProbePose pose = start;
    pose.axial = start.axial * std::cos(tilt) + elevation * std::sin(tilt);
    pose.lateral = start.lateral * std::cos(turn) + elevation * std::sin(turn);
    poses.push_back(pose.orthonormalized());
  }
  return poses;
}

ImageSettings a4cSettings()
{
  ImageSettings settings;
  settings.geometry.lineCount = 128;
  settings.geometry.depthMm = 160.0;
  settings.tracing.pathsPerLine = 1000;
  settings.tracing.maxCollisions = 7;
  settings.device = settings.tracing.device = settings.echo.device = Device::Cpu;
  settings.matchStages();
  return settings;
}

/// How often a beam of the job looks at a cell that may hold a scatterer: lines times the volume they see.
double cellVisits(const EchoSettings& echo, std::size_t lines)
{
  const double area = M_PI * 16.0 * echo.lateralSigmaMm * echo.elevationalSigmaMm;
  return double(lines) * area * echo.depthMm / std::pow(echo.scattererCellMm, 3);
}

void writeA4C(const std::string& folder)
{
  const auto scene = makePhantomScene(makeThoraxPhantom(1.0));
  const ImageSettings settings = a4cSettings();
  const auto poses = sweep();
  JobFile file;
  file.job = makeImageJob(*scene, poses, settings, {}, {});
  const auto lines = makeScanLines(settings.geometry, poses.front());
  file.cpuIq = formRf(*scene, lines, trace(*scene, lines, settings.tracing), settings.echo).iq;
  file.scatterers = cellVisits(settings.echo, lines.size());
  writeJob(file, folder + "/a4c.sonojob");
}

void writeS1(const std::string& folder)
{
  test::SceneS1 s1;
  s1.settings.device = Device::Cpu;
  const PointScatterers points(s1.points);
  const EchoSources sources{ nullptr, nullptr, &points };
  JobFile file;
  file.job.echo = makeEchoJob(EchoSetup(sources, s1.lines, s1.settings));
  file.cpuIq = formRf(sources, s1.lines, s1.settings).iq;
  file.scatterers = double(s1.points.size());
  writeJob(file, folder + "/s1.sonojob");
}

} // namespace

int main(int argc, char** argv)
{
  if (argc != 2)
  {
    std::fprintf(stderr, "usage: WriteGpuJobs FOLDER\n");
    return 2;
  }
  try
  {
    writeA4C(argv[1]);
    writeS1(argv[1]);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "WriteGpuJobs: %s\n", error.what());
    return 1;
  }
  return 0;
}
