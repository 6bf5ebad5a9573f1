#include "SonoAnatomy.h"

#include "Core/Progress.h"
#include "SonoContent.h"
#include "SonoStage.h"
#include "vtkSonoSceneBuilder.h"

#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkExecutive.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"

#include <algorithm>
#include <functional>
#include <string>
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

Anatomy::Anatomy(vtkAlgorithm* owner, vtkSonoSceneBuilder* builder, double progressEnd,
                 std::function<void(const std::string&)> say)
  : owner_(owner)
  , builder_(builder)
  , progressEnd_(progressEnd)
  , say_(std::move(say))
{
  keepQuiet(builder);
  vtkNew<ProgressEar> ear;
  ear->hear = [this](double fraction) { reportProgress(fraction); };
  ear_ = builder->AddObserver(vtkCommand::ProgressEvent, ear, first);
}

Anatomy::~Anatomy()
{
  builder_->RemoveObserver(ear_);
}

void Anatomy::reportProgress(double fraction)
{
  owner_->SetProgressText(builder_->GetProgressText());
  owner_->UpdateProgress(fraction * progressEnd_);
  if (owner_->CheckAbort())
  {
    builder_->SetAbortExecuteAndUpdateTime();
  }
}

vtkMultiBlockDataSet* Anatomy::blocks(vtkDataObject* input)
{
  if (!vtkImageData::SafeDownCast(input))
  {
    return vtkMultiBlockDataSet::SafeDownCast(input);
  }
  std::vector<double> content = contentOf(input);
  if (content != connected_)
  {
    // A copy, because a data object belongs to one pipeline.
    const auto copy = vtk::TakeSmartPointer(input->NewInstance());
    copy->ShallowCopy(input);
    builder_->SetInputDataObject(copy);
    connected_ = std::move(content);
    builtAt_ = 0;
  }
  if (const char* labels = owner_->GetInputArrayInformation(0)->Get(vtkDataObject::FIELD_NAME()))
  {
    builder_->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, labels);
  }
  if (builtAt_ != builder_->GetMTime())
  {
    builtAt_ = 0; // stays so when it fails
    update();
    builtAt_ = builder_->GetMTime();
  }
  return builder_->GetOutput();
}

vtkMultiBlockDataSet* Anatomy::builtBlocks(vtkDataObject* input) const
{
  if (!vtkImageData::SafeDownCast(input))
  {
    return vtkMultiBlockDataSet::SafeDownCast(input);
  }
  return builtAt_ == builder_->GetMTime() && contentOf(input) == connected_ ? builder_->GetOutput() : nullptr;
}

void Anatomy::update()
{
  const bool isMade = builder_->GetExecutive()->Update() != 0;
  warnings_ = takeWarnings(builder_);
  if (say_)
  {
    std::for_each(warnings_.begin(), warnings_.end(), say_);
  }
  if (!isMade)
  {
    const std::string sentence = saidBy(builder_);
    throw Error(sentence.empty() ? "The anatomy could not be built, without a reason; build it by an Ultrasound Scene "
                                   "of its own to find it."
                                 : sentence);
  }
  if (builder_->GetAbortExecute())
  {
    builder_->AbortExecuteOff();
    builder_->Modified(); // what it left is not whole
    throw Aborted();
  }
}

} // namespace sono
