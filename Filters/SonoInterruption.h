#pragma once

#include "vtkSonoFiltersModule.h" // for export macro

class vtkAlgorithm;
class vtkInformationVector;

namespace sono {

/// Who may stop the working filters of this process: a GUI with a button. Without one they run to their end, unless
/// VTK's AbortExecute stops them.
class VTKSONOFILTERS_EXPORT Interrupter
{
public:
  virtual ~Interrupter();

  /// Asked by a working filter many times a second, on the thread that runs the pipeline.
  virtual bool wantsStop() = 0;
  /// Told when a filter of the pipeline was stopped. It shows what it made before and does not try again until it, or
  /// what is upstream of it, is Modified.
  virtual void hasStopped(vtkAlgorithm* filter) = 0;
  /// Told when a filter of the pipeline has made its data.
  virtual void hasFinished(vtkAlgorithm* filter) = 0;
};

/// The interrupter of this process, or none (nullptr); not owned. It is asked and told by filters of this thread alone:
/// what others make in the background is no work that anybody waits for.
VTKSONOFILTERS_EXPORT void setInterrupter(Interrupter* interrupter);

/// Whether the interrupter, if there is one, wants work to stop.
bool stopIsWanted();

/// Keeps shallow copies of what a filter has just made, for the case that its next run is stopped; only while there is
/// an interrupter.
void keepOutputs(vtkAlgorithm* filter, vtkInformationVector* outputs);

/// After a stop: puts back the outputs that were kept, or marks them as aborted where none were, and suspends the
/// filter.
void restoreOutputs(vtkAlgorithm* filter, vtkInformationVector* outputs);

/// After a failure: marks the outputs as aborted, which empties them and all downstream without a word, and suspends
/// the filter.
void abortOutputs(vtkAlgorithm* filter);

/// Whether the filter is suspended and nothing has changed since, so that it need not run; its outputs are then put
/// back as they were left.
bool staysSuspended(vtkAlgorithm* filter, vtkInformationVector* outputs);

} // namespace sono
