#pragma once

#include "BusyScene.h"

#include "Simulator.h"

namespace sono::test {

/// One for all tests of a program.
inline std::shared_ptr<const Scene> busyScene()
{
  static const std::shared_ptr<const Scene> scene = makeBusyScene();
  return scene;
}

/// Of nine lines in the busy scene, on the CPU.
inline ImageInput smallInput()
{
  ImageInput input;
  input.pose.positionMm = { 32.0, 24.0, 0.0 };
  ImageSettings& s = input.settings;
  s.geometry.lineCount = 9;
  s.geometry.depthMm = 50.0;
  s.geometry.sectorDeg = 40.0;
  s.tracing.pathsPerLine = 64;
  s.tracing.radialBinMm = 0.5;
  s.echo.samplingMHz = 20.0;
  s.pixelMm = 0.5;
  s.matchStages();
  s.setDevice(Device::Cpu);
  return input;
}

} // namespace sono::test
