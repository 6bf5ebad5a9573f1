#pragma once

#include "SonoWindows.h"

#include <QString>

#include <vector>

class pqPipelineSource;

/// A pose of a probe and when it stood there.
struct SonoTimedPose
{
  double timeS = 0.0;
  std::array<double, 9> pose{}; ///< position, axial, lateral
};

/// A Probe Path in the pipeline with these poses, shown in the active view where that is in space. One step of undo.
pqPipelineSource* sonoMakePath(const std::vector<SonoTimedPose>& poses, pqPipelineSource* ultrasound);

/// The poses of a Probe Path.
std::vector<SonoTimedPose> sonoPathOf(pqPipelineSource* path);

/// Where a probe is on its way between two poses; before the first and after the last it stands there.
std::array<double, 9> sonoPoseAt(const std::vector<SonoTimedPose>& poses, double timeS);

/// An Ultrasound Sweep of a path by the label map, the probe and the settings of a Simulate Ultrasound, and the
/// Ultrasound Probe that it needs; it waits for Apply. One step of undo.
pqPipelineSource* sonoMakeSweep(pqPipelineSource* path, pqPipelineSource* ultrasound);

/// Writes a data set's file of which each image is one of a path's poses, with a mask of each structure of the anatomy.
/// Why that is not possible, one sentence; empty: it is done.
QString sonoWriteDataSet(pqPipelineSource* path, pqPipelineSource* ultrasound, const QString& file);
