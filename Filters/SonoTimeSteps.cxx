#include "SonoTimeSteps.h"

#include "Core/Parameters.h"
#include "Core/Progress.h"
#include "Core/Require.h"
#include "SonoStage.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkWriter.h"

namespace sono {
namespace {

using Pipeline = vtkStreamingDemandDrivenPipeline;

} // namespace

bool TimeSteps::process(vtkWriter* writer, const std::string& fileName, const StepWork& work, vtkInformation* request,
                        vtkInformationVector** input)
{
  vtkInformation* inInfo = input[0]->GetInformationObject(0);
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_INFORMATION()))
  {
    const int count = inInfo->Has(Pipeline::TIME_STEPS()) ? inInfo->Length(Pipeline::TIME_STEPS()) : 0;
    const double* times = inInfo->Get(Pipeline::TIME_STEPS());
    times_.assign(times, times + count);
    next_ = 0;
    return true;
  }
  if (request->Has(Pipeline::REQUEST_UPDATE_EXTENT()))
  {
    if (next_ < times_.size())
    {
      inInfo->Set(Pipeline::UPDATE_TIME_STEP(), times_[next_]);
    }
    requestWholeImage(input);
    return true;
  }
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_DATA()))
  {
    run(writer, fileName, work, request);
    return true;
  }
  return false;
}

void TimeSteps::run(vtkWriter* writer, const std::string& fileName, const StepWork& work, vtkInformation* request)
{
  request->Remove(Pipeline::CONTINUE_EXECUTING());
  bool isDone = false;
  const bool isRun = runWork(writer, [&] {
    if (writer->GetAbortOutput())
    {
      throw Aborted(); // the input was stopped, or has said why there is none
    }
    auto* image = vtkImageData::SafeDownCast(writer->GetInput());
    if (next_ == 0)
    {
      work.begin(image);
    }
    work.add(image);
    ++next_;
    if (next_ == count())
    {
      work.finish();
    }
    isDone = true;
  });
  if (isDone && next_ < count())
  {
    request->Set(Pipeline::CONTINUE_EXECUTING(), 1);
    return;
  }
  next_ = 0;
  work.end(isDone);
  if (isRun && !isDone)
  {
    warn(writer, "Stopped: '" + fileName + "' was not written; save it again.");
  }
}

void TimeSteps::tell(vtkWriter* writer, double fraction) const
{
  if (!progressOf(writer)((double(next_) + fraction) / double(count())))
  {
    throw Aborted();
  }
}

std::vector<double> frameTimesS(const TimeSteps& steps, std::size_t slices, double frameTimeMs)
{
  requireInRange(between(0, 100000).contains(frameTimeMs), "FrameTimeMs", frameTimeMs, "between 0 and 100000");
  constexpr double usualMs = 40.0;
  const bool timesAreSaid = frameTimeMs == 0.0 && steps.times().size() > 1 && slices == 1;
  const double stepMs = frameTimeMs > 0.0 ? frameTimeMs : usualMs;
  std::vector<double> timesS;
  for (std::size_t n = 0; n < slices * steps.count(); ++n)
  {
    timesS.push_back(timesAreSaid ? steps.times()[n] : 1e-3 * stepMs * double(n));
  }
  return timesS;
}

} // namespace sono
