#pragma once

#include "Echo/FormRf.h"
#include "Probe/ScanGeometry.h"
#include "Scene/Scene.h"
#include "Trace/Trace.h"

#include <memory>
#include <string>
#include <vector>

namespace sono::study {

/// A scene on which run time, error and precision are measured, with neighbouring scan lines through its middle; the
/// phantom's are as close as those of a fan of 2048, so that they meet its first wire.
struct BenchScene
{
  std::string name; ///< stack, cyst, rib, a4c or phantom
  std::shared_ptr<Scene> scene;
  std::vector<ScanLine> lines;
  std::vector<TargetSurface> targets; ///< the phantom's wires
  TraceSettings tracing;
  EchoSettings echo;
};

/// `spacingMm` is the edge of a voxel; 0 takes the scene's own (stack, a4c: 1; the others: 0.5). Throws Error for a
/// name that is not one of them.
BenchScene makeBenchScene(const std::string& name, double spacingMm = 0.0, int lineCount = 16);

/// The layers of `stack`: flat, across the beam, without spreading, so that every sum over paths is a finite one.
struct Layer
{
  double fromMm; ///< a multiple of 1 mm
  Tissue tissue;
};
const std::vector<Layer>& stackLayers();

/// A line down the stack in double precision: all sequences of reflections and transmissions of at most maxCollisions
/// boundaries, each with its probability.
struct StackLine
{
  std::vector<double> intensity;     ///< by bin
  std::vector<double> absorbed;      ///< A times that, A the attenuation that has been met, Np of intensity
  std::vector<double> depthOffsetMm; ///< at the range of each bin's start: what is shown there lies so much deeper
};
StackLine stackLine(const TraceSettings& tracing);

} // namespace sono::study
