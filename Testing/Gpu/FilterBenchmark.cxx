// FilterBenchmark [cpu]: what VTK costs around the simulator on a GPU, one `name value unit` a line: an image through
// vtkSonoUltrasound beside the same image from the simulator alone, and a sweep of 64 poses. All by the wall.
#include "PhantomScene.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Simulator.h"
#include "vtkSonoBMode.h"
#include "vtkSonoImageFormation.h"
#include "vtkSonoProbeSource.h"
#include "vtkSonoRayTracer.h"
#include "vtkSonoSceneBuilder.h"
#include "vtkSonoSweep.h"
#include "vtkSonoThoraxSource.h"
#include "vtkSonoUltrasound.h"

#include "vtkDoubleArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <functional>

namespace {

constexpr int repeats = 51;
constexpr int sweepRepeats = 11;
constexpr int poseCount = 64;

double wallMs(const std::function<void()>& work)
{
  const auto from = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - from).count();
}

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void print(const char* name, double value, const char* unit)
{
  std::printf("%s %.6g %s\n", name, value, unit);
}

/// The apical view, and from it a sweep: the probe tilts to and fro by 15 degrees and turns by 20.
vtkSmartPointer<vtkPolyData> sweepOf(const sono::ProbePose& start)
{
  vtkNew<vtkPoints> points;
  vtkNew<vtkDoubleArray> axial;
  vtkNew<vtkDoubleArray> lateral;
  axial->SetName("Axial");
  axial->SetNumberOfComponents(3);
  lateral->SetName("Lateral");
  lateral->SetNumberOfComponents(3);
  const sono::Vec3d elevation = glm::cross(start.axial, start.lateral);
  for (int i = 0; i < poseCount; ++i)
  {
    const double tilt = 0.26 * std::sin(2.0 * M_PI * i / poseCount);
    const double turn = 0.35 * i / poseCount;
    const sono::Vec3d a = start.axial * std::cos(tilt) + elevation * std::sin(tilt);
    const sono::Vec3d l = start.lateral * std::cos(turn) + elevation * std::sin(turn);
    points->InsertNextPoint(&start.positionMm.x);
    axial->InsertNextTuple(&a.x);
    lateral->InsertNextTuple(&l.x);
  }
  auto poses = vtkSmartPointer<vtkPolyData>::New();
  poses->SetPoints(points);
  poses->GetPointData()->AddArray(axial);
  poses->GetPointData()->AddArray(lateral);
  return poses;
}

void place(vtkSonoUltrasound* ultrasound, const sono::ProbePose& pose)
{
  const auto set = [](const sono::Vec3d& v, const auto& setter) { setter(v.x, v.y, v.z); };
  set(pose.positionMm, [&](double x, double y, double z) { ultrasound->GetProbe()->SetPositionMm(x, y, z); });
  set(pose.axial, [&](double x, double y, double z) { ultrasound->GetProbe()->SetAxial(x, y, z); });
  set(pose.lateral, [&](double x, double y, double z) { ultrasound->GetProbe()->SetLateral(x, y, z); });
}

void measure(sono::Device device)
{
  const sono::ProbePose pose = sono::thoraxPhantomA4C().orthonormalized();
  vtkNew<vtkSonoThoraxSource> thorax;
  vtkNew<vtkSonoUltrasound> ultrasound;
  ultrasound->SetInputConnection(thorax->GetOutputPort());
  ultrasound->GetSceneBuilder()->SetBuildSurfaces(false);
  ultrasound->GetRayTracer()->SetDevice(static_cast<int>(device));
  ultrasound->GetRayTracer()->SetMaxCollisions(7);
  ultrasound->GetRayTracer()->SetCoherenceMm(100.0);
  ultrasound->GetRayTracer()->SetLobeSigmaDeg(45.0);
  ultrasound->GetBMode()->SetTgcDbPerCm(5.0);
  place(ultrasound, pose);
  ultrasound->Update();

  sono::Simulator simulator(sono::makePhantomScene(sono::makeThoraxPhantom(1.0)));
  sono::ImageInput input;
  input.pose = pose;
  input.settings.echo.aperture = sono::ProbeSettings().aperture();
  input.settings.matchStages();
  input.settings.setDevice(device);

  // Turn by turn, so that both see the same machine; each image is another one.
  std::vector<double> bare;
  std::vector<double> through;
  sono::ScanPicture picture;
  for (int i = -5; i < repeats; ++i)
  {
    const double bareMs = wallMs([&] {
      input.settings.tracing.seed = input.settings.echo.seed = std::uint64_t(10 + i);
      picture = simulator.picture(simulator.image(input), input.settings.geometry, input.pose, simulator.traced(input));
    });
    const double throughMs = wallMs([&] {
      ultrasound->GetRayTracer()->SetPathSeed(10 + i);
      ultrasound->GetImageFormation()->SetScattererSeed(10 + i);
      ultrasound->Update();
    });
    if (i >= 0)
    {
      bare.push_back(bareMs);
      through.push_back(throughMs);
    }
  }
  print("filter_bare_image_ms", median(bare), "ms");
  print("filter_image_ms", median(through), "ms");
  print("filter_overhead_ms", median(through) - median(bare), "ms");
  auto* grey = vtkUnsignedCharArray::SafeDownCast(ultrasound->GetOutput()->GetPointData()->GetArray("BMode"));
  std::size_t differing = 0;
  for (std::size_t i = 0; i < picture.grey.size; ++i)
  {
    differing += picture.grey[i] != grey->GetValue(static_cast<vtkIdType>(i));
  }
  print("filter_differing_pixels", double(differing), "pixels");

  // A drag, 0.6 mm a step.
  std::vector<double> moved;
  ultrasound->GetProbe()->SetPreview(true);
  for (int i = -5; i < repeats; ++i)
  {
    const double ms = wallMs([&] {
      const sono::Vec3d at = pose.positionMm + 0.6 * double(i) * pose.lateral;
      ultrasound->GetProbe()->SetPositionMm(at.x, at.y, at.z);
      ultrasound->Update();
    });
    if (i >= 0)
    {
      moved.push_back(ms);
    }
  }
  print("filter_drag_pictures_per_s", 1e3 / median(moved), "1/s");
  print("filter_drag_pictures_per_s_least", 1e3 / *std::max_element(moved.begin(), moved.end()), "1/s");
  const auto pixels = double(ultrasound->GetOutput()->GetNumberOfPoints());
  ultrasound->GetProbe()->SetPreview(false);
  ultrasound->Update();
  print("filter_drag_share_of_pixels", pixels / double(ultrasound->GetOutput()->GetNumberOfPoints()), "1");

  vtkNew<vtkSonoProbeSource> probe;
  vtkNew<vtkSonoSceneBuilder> scene;
  scene->SetInputConnection(thorax->GetOutputPort());
  scene->SetBuildSurfaces(false);
  vtkNew<vtkSonoSweep> sweep;
  sweep->SetInputConnection(0, scene->GetOutputPort());
  sweep->SetInputConnection(1, probe->GetOutputPort());
  sweep->SetInputDataObject(2, sweepOf(pose));
  sweep->GetRayTracer()->SetDevice(static_cast<int>(device));
  sweep->GetRayTracer()->SetMaxCollisions(7);
  sweep->GetRayTracer()->SetCoherenceMm(100.0);
  sweep->GetRayTracer()->SetLobeSigmaDeg(45.0);
  for (const bool withLabels : { false, true })
  {
    sweep->SetWithLabels(withLabels);
    std::vector<double> ms;
    for (int i = -2; i < sweepRepeats; ++i)
    {
      sweep->Modified();
      const double took = wallMs([&] { sweep->Update(); });
      if (i >= 0)
      {
        ms.push_back(took);
      }
    }
    print(withLabels ? "filter_sweep_labels_images_per_s" : "filter_sweep_images_per_s", 1e3 * poseCount / median(ms),
          "1/s");
  }
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    const bool onCpu = argc > 1 && std::strcmp(argv[1], "cpu") == 0;
    measure(onCpu ? sono::Device::Cpu : sono::Device::Cuda);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "FilterBenchmark: %s\n", error.what());
    return 1;
  }
  return 0;
}
