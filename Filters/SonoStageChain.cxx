#include "SonoStageChain.h"

#include "Core/Progress.h"
#include "SonoStage.h"

#include "vtkAlgorithm.h"
#include "vtkCommand.h"
#include "vtkExecutive.h"
#include "vtkNew.h"

#include <algorithm>
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

void StageChain::update(vtkAlgorithm* last)
{
  const auto end = std::find_if(links_.begin(), links_.end(), [&](const Link& link) { return link.stage == last; }) + 1;
  for (auto link = links_.begin(); link != end; ++link)
  {
    vtkAlgorithm* stage = link->stage;
    if (stage->GetNumberOfInputPorts() > 0 && stage->GetNumberOfInputConnections(0) == 0)
    {
      continue; // not in use
    }
    const bool isMade = stage->GetExecutive()->Update() != 0;
    for (const std::string& sentence : takeWarnings(stage))
    {
      warn(owner_, sentence);
    }
    if (!isMade)
    {
      throwFailure();
    }
    if (stage->GetAbortExecute())
    {
      stage->AbortExecuteOff();
      stage->Modified(); // what it left is not whole
      throw Aborted();
    }
  }
}

} // namespace sono
