// Makes an image of the bundled thorax: consumer VERSION, the version that the library must have.
#include <sono/Core/Version.h>
#include <sono/Labels/AssignTissues.h>
#include <sono/Phantoms/ThoraxPhantom.h>
#include <sono/Simulator.h>

#include <cstddef>
#include <exception>
#include <iostream>
#include <memory>
#include <string>

namespace {

std::shared_ptr<const sono::Scene> thoraxScene()
{
  const std::string data = DATA_DIR;
  const auto tissues = sono::TissueTable::read(data + "/tissues.csv");
  sono::LabelVolume thorax = sono::makeThoraxPhantom(3.0);
  sono::assignTissues(thorax, sono::LabelTissueMap::read(data + "/label_tissues.csv"), tissues, "air");
  return std::make_shared<const sono::Scene>(thorax, tissues, "air");
}

/// Intensity is 1 at the transducer, where a boundary sends back that at most; little is left behind.
bool linesFade(const sono::TracedLines& lines)
{
  for (int line = 0; line < lines.lineCount; ++line)
  {
    const float first = lines.intensity[line * lines.binCount];
    const float last = lines.intensity[(line + 1) * lines.binCount - 1];
    if (!(first > 0.9f && first <= 2.0f && last < 0.1f))
    {
      std::cerr << "Line " << line << " begins with " << first << " and ends with " << last << '\n';
      return false;
    }
  }
  return true;
}

/// Inside the sector there are several greys, the darkest being 1; outside there is 0.
bool isPicture(const sono::ScanPicture& picture)
{
  int brightest = 0;
  for (std::size_t i = 0; i < picture.grey.size; ++i)
  {
    if ((picture.grey[i] == 0) != (picture.mask[i] == 0))
    {
      std::cerr << "Pixel " << i << " is " << int(picture.grey[i]) << " where the mask is " << int(picture.mask[i])
                << '\n';
      return false;
    }
    brightest = picture.grey[i] > brightest ? picture.grey[i] : brightest;
  }
  std::cout << picture.grey.size << " pixels, the brightest " << brightest << '\n';
  return brightest > 100;
}

bool imageThorax()
{
  sono::Simulator simulator(thoraxScene());
  sono::ImageInput input;
  input.pose = sono::thoraxPhantomA4C();
  input.settings.geometry.lineCount = 8;
  input.settings.tracing.pathsPerLine = 50;
  input.settings.matchStages();
  input.settings.setDevice(sono::Device::Cpu);
  const sono::ImageResult image = simulator.image(input);
  return linesFade(simulator.traced(input).host()) &&
         isPicture(simulator.picture(image, input.settings.geometry, input.pose, simulator.traced(input)));
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
    return imageThorax() ? 0 : 1;
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
