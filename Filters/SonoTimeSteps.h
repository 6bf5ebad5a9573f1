#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

class vtkImageData;
class vtkInformation;
class vtkInformationVector;
class vtkWriter;

namespace sono {

/// How a writer makes a file of all time steps of its input, of which it holds one at a time.
struct StepWork
{
  std::function<void(vtkImageData*)> begin; ///< the first time step: opens the file
  std::function<void(vtkImageData*)> add;   ///< each time step, the first among them
  std::function<void()> finish;             ///< the file is whole
  std::function<void(bool)> end; ///< after that, or where it failed or was stopped: whether the file is there
};

/// The time steps of a writer's input, and which comes next.
class TimeSteps
{
public:
  /// A pass of the pipeline in the writer's ProcessRequest, true where it was one. What went wrong is said once.
  /// `fileName` is for messages.
  bool process(vtkWriter* writer, const std::string& fileName, const StepWork& work, vtkInformation* request,
               vtkInformationVector** input);

  /// In s, as a rule; empty where the input has no time.
  const std::vector<double>& times() const { return times_; }
  /// Without time, too, there is one step.
  std::size_t count() const { return times_.empty() ? 1 : times_.size(); }
  /// Tells of the progress, `fraction` of this step. Throws Aborted when asked to stop.
  void tell(vtkWriter* writer, double fraction) const;

private:
  void run(vtkWriter* writer, const std::string& fileName, const StepWork& work, vtkInformation* request);

  std::vector<double> times_;
  std::size_t next_ = 0;
};

/// The times of `slices` x count() frames, in s: the time steps where `frameTimeMs` is 0 and they say it, else equal
/// steps, of 40 ms where it is 0. Throws Error for one out of range (0 to 100,000).
std::vector<double> frameTimesS(const TimeSteps& steps, std::size_t slices, double frameTimeMs);

} // namespace sono
