#include "SonoStageChain.h"

#include "Core/Progress.h"
#include "SonoStage.h"

#include "vtkAlgorithm.h"
#include "vtkCommand.h"
#include "vtkExecutive.h"
#include "vtkNew.h"

#include <utility>

namespace sono {
namespace {

/// Hands a stage's progress to a function.
class ProgressEar : public vtkCommand
{
public:
  static ProgressEar* New() { return new ProgressEar; }
  void Execute(vtkObject*, unsigned long, void* fraction) override
  {
    hear(*static_cast<double*>(fraction));
    this->AbortFlagOn(); // ParaView, which made the stage, would show its progress beside the owner's
  }

  std::function<void(double)> hear;
};

constexpr float first = 1.0f; // priority

} // namespace

StageChain::StageChain(vtkAlgorithm* owner, std::vector<Link> links)
  : owner_(owner)
  , links_(std::move(links))
{
  for (std::size_t i = 0; i < links_.size(); ++i)
  {
    keepQuiet(links_[i].stage);
    vtkNew<ProgressEar> ear;
    ear->hear = [this, i](double fraction) { reportProgress(i, fraction); };
    ears_.push_back(links_[i].stage->AddObserver(vtkCommand::ProgressEvent, ear, first));
  }
}

StageChain::~StageChain()
{
  for (std::size_t i = 0; i < links_.size(); ++i)
  {
    links_[i].stage->RemoveObserver(ears_[i]);
  }
}

void StageChain::reportProgress(std::size_t link, double fraction)
{
  const double begin = link > 0 ? links_[link - 1].progressEnd : 0.0;
  owner_->SetProgressText(links_[link].stage->GetProgressText());
  owner_->UpdateProgress(begin + fraction * (links_[link].progressEnd - begin));
  if (owner_->CheckAbort())
  {
    links_[link].stage->SetAbortExecuteAndUpdateTime();
  }
}

void StageChain::throwFailure() const
{
  for (const Link& link : links_)
  {
    const std::string sentence = saidBy(link.stage);
    if (!sentence.empty())
    {
      throw Error(sentence);
    }
  }
  throw Error("A stage of the simulation failed without saying why; run the stages one by one to find it.");
}

void StageChain::updateInformation()
{
  if (!links_.back().stage->GetExecutive()->UpdateInformation())
  {
    throwFailure();
  }
}

void StageChain::update()
{
  for (const Link& link : links_)
  {
    if (link.stage->GetNumberOfInputPorts() > 0 && link.stage->GetNumberOfInputConnections(0) == 0)
    {
      continue; // not in use
    }
    const bool isMade = link.stage->GetExecutive()->Update() != 0;
    for (const std::string& sentence : takeWarnings(link.stage))
    {
      warn(owner_, sentence);
    }
    if (!isMade)
    {
      throwFailure();
    }
    if (link.stage->GetAbortExecute())
    {
      link.stage->AbortExecuteOff();
      link.stage->Modified(); // what it left is not whole
      throw Aborted();
    }
  }
}

} // namespace sono
