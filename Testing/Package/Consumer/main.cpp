// Traces a few lines through the bundled thorax: consumer VERSION, the version that the library must have.
#include <sono/Core/Version.h>
#include <sono/Labels/AssignTissues.h>
#include <sono/Phantoms/ThoraxPhantom.h>
#include <sono/Trace/Trace.h>

#include <cmath>
#include <exception>
#include <iostream>
#include <string>

namespace {

int traceThorax()
{
  const std::string data = DATA_DIR;
  const auto tissues = sono::TissueTable::read(data + "/tissues.csv");
  sono::LabelVolume thorax = sono::makeThoraxPhantom(3.0);
  sono::assignTissues(thorax, sono::LabelTissueMap::read(data + "/label_tissues.csv"), tissues, "air");
  const sono::Scene scene(thorax, tissues, "air");

  sono::ScanGeometry geometry;
  geometry.lineCount = 8;
  sono::TraceSettings settings;
  settings.device = sono::Device::Cpu;
  settings.depthMm = geometry.depthMm;
  settings.pathsPerLine = 50;
  settings.model = sono::InterfaceModel::Amadou2024; // whose paths bring the boundaries' echoes
  const sono::TracedLines lines = sono::trace(scene, sono::makeScanLines(geometry, sono::thoraxPhantomA4C()), settings);

  int peak = 0;
  for (int sample = 0; sample < int(lines.boundaryEcho.size()); ++sample)
  {
    peak = std::abs(lines.boundaryEcho[sample]) > std::abs(lines.boundaryEcho[peak]) ? sample : peak;
  }
  const float amplitude = std::abs(lines.boundaryEcho[peak]);
  std::cout << "Peak boundary echo " << amplitude << " on line " << peak / lines.echoCount << " at "
            << peak % lines.echoCount * lines.echoSampleMm << " mm\n";

  // Intensity is 1 at the transducer, where a boundary sends back that at most; little is left behind.
  for (int line = 0; line < lines.lineCount; ++line)
  {
    const float first = lines.intensity[line * lines.binCount];
    const float last = lines.intensity[(line + 1) * lines.binCount - 1];
    if (!(first > 0.9f && first <= 2.0f && last < 0.1f))
    {
      std::cerr << "Line " << line << " begins with " << first << " and ends with " << last << '\n';
      return 1;
    }
  }
  return lines.lineCount == geometry.lineCount && amplitude > 0.0f && amplitude < 1.0f ? 0 : 1;
}

} // namespace

int main(int argc, char** argv)
{
  if (argc != 2 || std::string(argv[1]) != sono::version())
  {
    std::cerr << "The library's version is " << sono::version() << '\n';
    return 1;
  }
  try
  {
    return traceThorax();
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
