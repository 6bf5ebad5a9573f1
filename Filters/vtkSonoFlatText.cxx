#include "vtkSonoFlatText.h"

#include "SonoDataFile.h"
#include "SonoProbeField.h"
#include "SonoStage.h"

#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkSonoFlatText);

namespace {

/// Read once: they come with the program.
const std::vector<sono::ProbePreset>& bundledPresets()
{
  static const auto presets = [] {
    std::vector<sono::ProbePreset> read;
    for (const std::string& name : sono::dataFiles("probes", ".json"))
    {
      read.push_back(sono::readProbePreset(sono::dataFile("probes/" + name + ".json")));
    }
    return read;
  }();
  return presets;
}

/// As it is built, however it is driven: depth, lines, frequency and focus may be other ones.
bool isSameArray(const sono::ProbeSettings& a, const sono::ProbeSettings& b)
{
  const auto same = [](double x, double y) { return std::abs(x - y) <= 1e-6 * std::abs(y); };
  return a.geometry.kind == b.geometry.kind && a.elementCount == b.elementCount &&
         same(a.elementWidthMm, b.elementWidthMm) && same(a.kerfMm, b.kerfMm) &&
         same(a.elevationApertureMm, b.elevationApertureMm);
}

std::string nameOf(const sono::ProbeSettings& probe)
{
  const auto& presets = bundledPresets();
  const auto found =
    std::find_if(presets.begin(), presets.end(), [&](const auto& preset) { return isSameArray(probe, preset); });
  return found != presets.end() ? found->name : sono::traitsOf(probe.geometry.kind).label;
}

/// One decimal at most, and no more than are needed.
std::string rounded(double value)
{
  std::ostringstream words;
  words << std::round(value * 10.0) / 10.0 + 0.0;
  return words.str();
}

/// The sound goes there and back, a line at a time, and what is shown of a range is by the assumed speed.
double framesPerS(const sono::ScanGeometry& geometry)
{
  constexpr double mmPerM = 1000.0;
  return geometry.assumedSoundSpeedMPerS * mmPerM / (2.0 * geometry.depthMm * geometry.totalLineCount());
}

std::string textOf(vtkFieldData* fields)
{
  const sono::ProbeField probe = sono::readProbe(fields);
  std::ostringstream text;
  text << nameOf(probe) << "\n" << rounded(probe.centreFrequencyMHz);
  if (probe.imagingMode == sono::ImagingMode::Harmonic)
  {
    text << " / " << rounded(probe.receivedMHz()) << " MHz harmonic\n";
  }
  else
  {
    text << " MHz\n";
  }
  text << "Depth " << rounded(probe.geometry.depthMm) << " mm";
  const auto addNumber = [&](const char* array, const std::string& before, const std::string& after) {
    if (fields->HasArray(array))
    {
      text << "\n" << before << rounded(sono::readNumber(array, fields)) << after;
    }
  };
  addNumber("GainDb", "Gain ", " dB");
  addNumber("DynamicRangeDb", "Range ", " dB");
  text << "\n" << rounded(framesPerS(probe.geometry)) << " Hz";
  addNumber("TracedPaths", "", " paths a line");
  addNumber("ErrorDb", "Error ", " dB");
  return text.str();
}

} // namespace

vtkSonoFlatText::vtkSonoFlatText() = default;
vtkSonoFlatText::~vtkSonoFlatText() = default;

void vtkSonoFlatText::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

int vtkSonoFlatText::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

int vtkSonoFlatText::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    vtkNew<vtkStringArray> text;
    text->SetName("Text");
    text->InsertNextValue(textOf(vtkImageData::GetData(input[0])->GetFieldData()));
    vtkTable* table = vtkTable::GetData(output);
    table->AddColumn(text);
    table->GetFieldData()->Initialize(); // of the input's, which VTK passes on, nothing that shows a text has a use
  });
}
