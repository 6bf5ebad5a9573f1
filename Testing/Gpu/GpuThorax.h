#pragma once

#include "GpuParity.h"
#include "PhantomScene.h"
#include "Phantoms/ThoraxPhantom.h"

namespace sono::test {

inline const Scene& thorax()
{
  static const auto scene = makePhantomScene(makeThoraxPhantom(2.0));
  return *scene;
}

inline ImageSettings thoraxSettings()
{
  ImageSettings s;
  s.geometry.lineCount = 64;
  s.tracing.pathsPerLine = 1000;
  s.matchStages();
  return s;
}

inline Chain thoraxChain(const ImageSettings& s, Device device)
{
  const auto lines = makeScanLines(s.geometry, thoraxPhantomA4C().orthonormalized());
  return runChain({ &thorax(), nullptr, nullptr }, lines, s.tracing, s.echo, device);
}

} // namespace sono::test
