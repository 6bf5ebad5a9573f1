#include "SonoStage.h"

#include "SonoInterruption.h"

#include "vtkAlgorithm.h"
#include "vtkCommand.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkExecutive.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationStringKey.h"
#include "vtkInformationStringVectorKey.h"
#include "vtkInformationUnsignedLongKey.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkOutputWindow.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <chrono>
#include <cstring>
#include <mutex>
#include <new>
#include <set>
#include <thread>

namespace sono {
namespace {

/// After a quiet stage has failed, its executive adds messages of its own: that the request failed, with the request's
/// innards, or that the image which could not be announced has no extent. They are dropped; others pass.
class OneSentence : public vtkCommand
{
public:
  static OneSentence* New() { return new OneSentence; }
  void Execute(vtkObject*, unsigned long, void* text) override
  {
    const auto* message = static_cast<const char*>(text);
    if (!std::strstr(message, "returned failure for request") && !std::strstr(message, "No whole extent has been set"))
    {
      vtkOutputWindowDisplayErrorText(message);
    }
  }
};

/// The last sentence of an algorithm and the pipeline's time then.
vtkInformationStringKey* saidKey()
{
  static auto* const key = vtkInformationStringKey::MakeKey("SAID", "SonoVDB");
  return key;
}

vtkInformationUnsignedLongKey* saidAtKey()
{
  static auto* const key = vtkInformationUnsignedLongKey::MakeKey("SAID_AT", "SonoVDB");
  return key;
}

vtkInformationIntegerKey* quietKey()
{
  static auto* const key = vtkInformationIntegerKey::MakeKey("QUIET", "SonoVDB");
  return key;
}

/// Whether a filter around it speaks for an algorithm, see keepQuiet.
bool isInner(vtkAlgorithm* algorithm)
{
  return algorithm->GetInformation()->Has(quietKey());
}

/// What a quiet algorithm has warned of.
vtkInformationStringVectorKey* warnedKey()
{
  static auto* const key = vtkInformationStringVectorKey::MakeKey("WARNED", "SonoVDB");
  return key;
}

/// Of an algorithm that could not announce what it will make, and has said why.
vtkInformationIntegerKey* refusedKey()
{
  static auto* const key = vtkInformationIntegerKey::MakeKey("REFUSED", "SonoVDB");
  return key;
}

/// Says what is wrong, but not twice while nothing changes: a viewer asks a failed pipeline again and again.
void say(vtkAlgorithm* algorithm, const char* sentence)
{
  auto* pipeline = vtkDemandDrivenPipeline::SafeDownCast(algorithm->GetExecutive());
  const unsigned long now = pipeline ? pipeline->GetPipelineMTime() : algorithm->GetMTime();
  vtkInformation* memory = algorithm->GetInformation();
  const char* said = memory->Get(saidKey());
  if (!said || std::strcmp(said, sentence) != 0 || memory->Get(saidAtKey()) != now)
  {
    memory->Set(saidKey(), sentence);
    memory->Set(saidAtKey(), now);
    if (!isInner(algorithm))
    {
      vtkErrorWithObjectMacro(algorithm, << sentence);
    }
  }
}

enum class Outcome
{
  Done,
  Stopped,
  Failed
};

Outcome attempt(vtkAlgorithm* algorithm, const std::function<void()>& work)
{
  if (isInner(algorithm))
  {
    algorithm->GetInformation()->Remove(saidKey());
  }
  try
  {
    work();
    return Outcome::Done;
  }
  catch (const Aborted&)
  {
    return Outcome::Stopped;
  }
  catch (const std::bad_alloc&)
  {
    say(algorithm, "There is not enough memory for this stage; use a coarser or smaller input.");
  }
  catch (const std::exception& error)
  {
    say(algorithm, error.what());
  }
  return Outcome::Failed;
}

void announceNothing(vtkAlgorithm* algorithm)
{
  const int empty[6] = { 0, -1, 0, -1, 0, -1 };
  for (int port = 0; port < algorithm->GetNumberOfOutputPorts(); ++port)
  {
    vtkInformation* outInfo = algorithm->GetOutputInformation(port);
    if (vtkImageData::GetData(outInfo))
    {
      outInfo->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), empty, 6);
      outInfo->Set(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), empty, 6);
    }
  }
}

} // namespace

Progress progressOf(vtkAlgorithm* algorithm, double quietS)
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point tells =
    Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(quietS));
  return [algorithm, tells, caller = std::this_thread::get_id()](double fraction) {
    if (std::this_thread::get_id() != caller)
    {
      return !algorithm->GetAbortExecute();
    }
    if (Clock::now() >= tells)
    {
      algorithm->UpdateProgress(fraction);
    }
    return !algorithm->CheckAbort() && !stopIsWanted();
  };
}

void warn(vtkAlgorithm* algorithm, const std::string& sentence)
{
  if (isInner(algorithm))
  {
    algorithm->GetInformation()->Append(warnedKey(), sentence);
  }
  else
  {
    vtkWarningWithObjectMacro(algorithm, << sentence);
  }
}

void keepQuiet(vtkAlgorithm* algorithm)
{
  algorithm->GetInformation()->Set(quietKey(), 1);
  vtkNew<OneSentence> filter;
  algorithm->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, filter);
}

std::string saidBy(vtkAlgorithm* algorithm)
{
  const char* said = algorithm->GetInformation()->Get(saidKey());
  return said ? said : "";
}

std::vector<std::string> takeWarnings(vtkAlgorithm* algorithm)
{
  vtkInformation* memory = algorithm->GetInformation();
  std::vector<std::string> sentences;
  for (int i = 0; i < memory->Length(warnedKey()); ++i)
  {
    sentences.emplace_back(memory->Get(warnedKey(), i));
  }
  memory->Remove(warnedKey());
  return sentences;
}

bool runWork(vtkAlgorithm* algorithm, const std::function<void()>& work)
{
  return attempt(algorithm, work) != Outcome::Failed;
}

void requireConnected(vtkInformationVector* input, const std::string& sentence)
{
  if (!input->GetInformationObject(0))
  {
    throw Error(sentence);
  }
}

int announceStage(vtkAlgorithm* algorithm, const std::function<void()>& work)
{
  if (attempt(algorithm, work) != Outcome::Failed)
  {
    algorithm->GetInformation()->Remove(refusedKey());
    return 1;
  }
  if (isInner(algorithm))
  {
    return 0;
  }
  algorithm->GetInformation()->Set(refusedKey(), 1);
  announceNothing(algorithm);
  return 1;
}

int runStage(vtkAlgorithm* algorithm, vtkInformationVector* outputVector, const std::function<void()>& work)
{
  const auto piece = vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER();
  for (int port = 0; port < outputVector->GetNumberOfInformationObjects(); ++port)
  {
    vtkInformation* outInfo = outputVector->GetInformationObject(port);
    if (outInfo->Has(piece) && outInfo->Get(piece) > 0)
    {
      return 1;
    }
  }
  if (algorithm->GetAbortOutput() || staysSuspended(algorithm, outputVector))
  {
    return 1; // its input was stopped or failed, or it was or did itself
  }
  if (algorithm->GetInformation()->Has(refusedKey()))
  {
    abortOutputs(algorithm);
    return 1;
  }
  const bool inner = isInner(algorithm);
  const Outcome outcome = attempt(algorithm, work);
  if (outcome == Outcome::Done && !inner)
  {
    keepOutputs(algorithm, outputVector);
  }
  else if (outcome == Outcome::Stopped && !algorithm->GetAbortOutput()) // not by VTK, which empties the outputs
  {
    if (inner)
    {
      algorithm->SetAbortExecute(1); // for the filter around it
      algorithm->SetAbortOutput(true);
    }
    else
    {
      restoreOutputs(algorithm, outputVector);
    }
  }
  else if (outcome == Outcome::Failed)
  {
    if (inner)
    {
      return 0;
    }
    abortOutputs(algorithm);
  }
  return 1;
}

void announceDevice(const DeviceChoice& choice)
{
  static std::mutex mutex;
  static std::set<std::string> said;
  const std::lock_guard<std::mutex> lock(mutex);
  if (!choice.note.empty() && said.insert(choice.note).second)
  {
    vtkOutputWindowDisplayText((choice.note + "\n").c_str());
  }
}

int requestWholeImage(vtkInformationVector** inputVector, int port)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* inInfo = inputVector[port]->GetInformationObject(0);
  if (!inInfo)
  {
    return 1; // an optional input that is not connected
  }
  int extent[6];
  inInfo->Get(Pipeline::WHOLE_EXTENT(), extent);
  inInfo->Set(Pipeline::UPDATE_EXTENT(), extent, 6);
  return 1;
}

} // namespace sono
