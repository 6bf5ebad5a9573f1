#include "vtkSonoPhasesAhead.h"

#include "Core/LeaveACore.h"
#include "SonoPlayed.h"
#include "SonoStage.h"
#include "vtkSonoBMode.h"
#include "vtkSonoImageFormation.h"
#include "vtkSonoProbeSource.h"
#include "vtkSonoRayTracer.h"
#include "vtkSonoScanConverter.h"
#include "vtkSonoSceneBuilder.h"
#include "vtkSonoUltrasound.h"

#include "vtkAlgorithm.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

vtkStandardNewMacro(vtkSonoPhasesAhead);

namespace {

std::vector<double> timesOf(vtkAlgorithm* source)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  source->UpdateInformation();
  vtkInformation* info = source->GetOutputInformation(0);
  const double* times = info->Get(Pipeline::TIME_STEPS());
  return times ? std::vector<double>(times, times + info->Length(Pipeline::TIME_STEPS())) : std::vector<double>();
}

} // namespace

struct vtkSonoPhasesAhead::Work
{
  struct Line
  {
    vtkSmartPointer<vtkAlgorithm> source;
    vtkSmartPointer<vtkSonoUltrasound> ultrasound;

    std::vector<vtkAlgorithm*> parts() const
    {
      return { source,
               ultrasound,
               ultrasound->GetSceneBuilder(),
               ultrasound->GetProbe(),
               ultrasound->GetRayTracer(),
               ultrasound->GetImageFormation(),
               ultrasound->GetBMode(),
               ultrasound->GetScanConverter() };
    }
  };

  Line first;
  Line second;
  std::vector<double> times;
  vtkMTimeType sourceTime; ///< of the first one, when it began
  int taken = 0;
  std::atomic<int> made{ 0 };
  std::atomic<bool> isUnwanted{ false };
  std::atomic<bool> hasEnded{ false };
  std::thread thread;

  ~Work()
  {
    stop();
    thread.join();
  }
  void stop()
  {
    isUnwanted = true;
    for (vtkAlgorithm* part : second.parts())
    {
      part->SetAbortExecute(1);
    }
  }
  void run()
  {
    for (double time : times)
    {
      // Where what is kept had to go for it, there is no room for more: the rest is made when it is shown.
      const std::size_t before = sono::playedBytes();
      if (isUnwanted || !second.ultrasound->UpdateTimeStep(time) || isUnwanted ||
          !sono::saidBy(second.ultrasound).empty() || sono::playedBytes() < before)
      {
        break;
      }
      ++made;
    }
    hasEnded = true;
  }
};

vtkSonoPhasesAhead::vtkSonoPhasesAhead() = default;
vtkSonoPhasesAhead::~vtkSonoPhasesAhead() = default;

void vtkSonoPhasesAhead::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Number of phases: " << this->GetNumberOfPhases() << endl;
}

void vtkSonoPhasesAhead::Begin(vtkAlgorithm* source, vtkSonoUltrasound* ultrasound, vtkAlgorithm* secondSource,
                               vtkSonoUltrasound* secondUltrasound)
{
  this->Inside = std::make_unique<Work>();
  Work& work = *this->Inside;
  work.first = { source, ultrasound };
  work.second = { secondSource, secondUltrasound };
  work.times = timesOf(source);
  work.sourceTime = source->GetMTime();
  for (vtkAlgorithm* part : work.second.parts())
  {
    part->RemoveAllObservers(); // which are for the thread of a window
    sono::keepQuiet(part);
  }
  secondUltrasound->SetInputConnection(0, secondSource->GetOutputPort());
  work.thread = std::thread([&work] { sono::leavingACore([&work] { work.run(); }); });
}

int vtkSonoPhasesAhead::TakeReady()
{
  Work& work = *this->Inside;
  if (work.first.source->GetMTime() != work.sourceTime)
  {
    this->Stop();
  }
  const bool isOver = work.isUnwanted || work.hasEnded; // asked first: what ends now has counted its phases
  const int made = work.made;
  if (!work.isUnwanted)
  {
    sono::givePlayed(work.second.source, work.first.source);
    sono::givePlayed(work.second.ultrasound, work.first.ultrasound);
    sono::givePlayed(work.second.ultrasound->GetSceneBuilder(), work.first.ultrasound->GetSceneBuilder());
  }
  work.taken = isOver ? this->GetNumberOfPhases() : made;
  return work.taken;
}

int vtkSonoPhasesAhead::GetNumberOfPhases()
{
  return this->Inside ? static_cast<int>(this->Inside->times.size()) : 0;
}

bool vtkSonoPhasesAhead::IsReady(double time)
{
  const std::vector<double>& times = this->Inside->times;
  const auto after = std::upper_bound(times.begin(), times.end(), time + 1e-9);
  return after - times.begin() <= this->Inside->taken;
}

void vtkSonoPhasesAhead::Stop()
{
  if (this->Inside)
  {
    this->Inside->stop();
  }
}

bool vtkSonoPhasesAhead::HasEnded()
{
  return !this->Inside || this->Inside->hasEnded;
}
