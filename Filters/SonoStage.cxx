#include "SonoStage.h"

#include "vtkAlgorithm.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <new>
#include <thread>

namespace sono {

Progress progressOf(vtkAlgorithm* algorithm)
{
  return [algorithm, caller = std::this_thread::get_id()](double fraction) {
    if (std::this_thread::get_id() != caller)
    {
      return !algorithm->GetAbortExecute();
    }
    algorithm->UpdateProgress(fraction);
    return !algorithm->CheckAbort();
  };
}

Progress partOf(const Progress& whole, double from, double to)
{
  return [=](double fraction) { return !whole || whole(from + fraction * (to - from)); };
}

int announceStage(vtkAlgorithm* algorithm, const std::function<void()>& work)
{
  try
  {
    work();
    return 1;
  }
  catch (const Aborted&)
  {
    return 1;
  }
  catch (const std::bad_alloc&)
  {
    vtkErrorWithObjectMacro(algorithm, << "There is not enough memory for this stage; use a coarser or smaller input.");
  }
  catch (const std::exception& error)
  {
    vtkErrorWithObjectMacro(algorithm, << error.what());
  }
  return 0;
}

int runStage(vtkAlgorithm* algorithm, vtkInformationVector* outputVector, const std::function<void()>& work)
{
  vtkInformation* outInfo = outputVector->GetInformationObject(0);
  const auto piece = vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER();
  if (outInfo->Has(piece) && outInfo->Get(piece) > 0)
  {
    return 1;
  }
  return announceStage(algorithm, work);
}

int requestWholeImage(vtkInformationVector** inputVector)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* inInfo = inputVector[0]->GetInformationObject(0);
  int extent[6];
  inInfo->Get(Pipeline::WHOLE_EXTENT(), extent);
  inInfo->Set(Pipeline::UPDATE_EXTENT(), extent, 6);
  return 1;
}

} // namespace sono
