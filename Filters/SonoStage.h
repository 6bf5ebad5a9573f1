#pragma once

#include "Core/Device.h"
#include "Core/Progress.h"

#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkInformationVector;

namespace sono {

/// Progress for Simulation's loops: forwards to UpdateProgress and asks CheckAbort and the interrupter on the calling
/// thread, where VTK may be touched; worker threads only look at the abort flag, which is atomic. Nothing is forwarded
/// in the first `quietS` seconds.
Progress progressOf(vtkAlgorithm* algorithm, double quietS = 0.0);

/// Runs a stage's work and gives RequestData's return value. An exception becomes one vtkErrorMacro sentence and leaves
/// the outputs empty, as an abort, which is quiet, does; either way no stage downstream works, or says anything, on
/// what is missing. The value is then 1 all the same, because after a 0 each viewer adds an error of its own at each
/// look. Stopped by the interrupter (SonoInterruption.h), a stage keeps its data of before. In parallel, only the first
/// piece works; the others stay empty, because the stages do not split their data.
int runStage(vtkAlgorithm* algorithm, vtkInformationVector* outputVector, const std::function<void()>& work);

/// The same for RequestInformation, which every piece needs; after an exception images are announced without voxels.
int announceStage(vtkAlgorithm* algorithm, const std::function<void()>& work);

/// For what announceStage does: throws Error with the sentence where nothing is connected to an input that VTK does not
/// ask for. Where VTK asks, its pipeline says so itself, at each look and in words of its own.
void requireConnected(vtkInformationVector* input, const std::string& sentence);

/// The same as runStage for work that is neither, as writing a file is; false after an exception.
bool runWork(vtkAlgorithm* algorithm, const std::function<void()>& work);

/// Tells the observers of WarningEvent, or else the output window, what a person should know of a result that is made
/// all the same.
void warn(vtkAlgorithm* algorithm, const std::string& sentence);

/// For a stage inside another filter: what it has to say is kept for `saidBy` and `takeWarnings` and told to nobody,
/// and a failure is a 0.
void keepQuiet(vtkAlgorithm* algorithm);

/// What a quiet stage said in its last pass; empty where that went well.
std::string saidBy(vtkAlgorithm* algorithm);

/// What a quiet stage has warned of since this was last called, for the filter around it to `warn` of.
std::vector<std::string> takeWarnings(vtkAlgorithm* algorithm);

/// Says, once in a process, why Auto does not take a GPU.
void announceDevice(const DeviceChoice& choice);

/// RequestUpdateExtent for a stage that needs the whole image of a port, whatever part of its output is asked for.
int requestWholeImage(vtkInformationVector** inputVector, int port = 0);

} // namespace sono
