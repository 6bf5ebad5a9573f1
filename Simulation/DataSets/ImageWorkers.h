#pragma once

#include "Core/Progress.h"
#include "DataSets/DataSetImager.h"

#include <functional>
#include <vector>

namespace sono {

/// How many images to make side by side: one on a CPU, where an image takes all cores; half as many again as cores,
/// up to 24 for each GPU, so that it works on several while cores prepare and write others.
int imageWorkers(const DataSetImager& imager);

/// Images that are made one after the other by one worker: those of a body, whose preparation takes as long as hundreds
/// of its images. Of the first bodies, one for each worker, the first ones get a smaller part at first, and what is
/// left of them comes last, the largest part first: so workers come to their next bodies one after the other, while
/// others keep the device busy, and end together. Where there are fewer bodies than workers: equal parts of each. Of
/// `images`, whole exams.
std::vector<PlannedRange> workUnits(const DataSetPlan& plan, const PlannedRange& images, int workers);

/// What is to be done for the images of an exam: calls `done` for each of them.
using ExamWork =
  std::function<void(DataSetImager&, const PlannedRange& exam, const std::function<void()>& done, const Progress&)>;

/// Runs the work for each exam of all units, in their order on the calling thread by `imager`, or each unit on one of
/// several threads by an imager of its own, with loops on that thread's core but for bodies. The calling thread hears
/// of each image that is done, and is asked now and then whether to go on. Throws what a work throws, the first of
/// several, when all have stopped; Aborted.
void forExams(DataSetImager& imager, const std::vector<PlannedRange>& units, int workers, const ExamWork& work,
              const std::function<void()>& hear, const Progress& keepsOn);

} // namespace sono
