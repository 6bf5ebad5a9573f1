#include "vtkSonoBMode.h"

#include "Echo/Pulse.h"
#include "Image/BMode.h"
#include "Image/GreyMap.h"
#include "Image/Haze.h"
#include "Simulator.h"
#include "SonoDataFile.h"
#include "SonoLineImage.h"
#include "SonoOutputs.h"
#include "SonoProbeField.h"
#include "SonoSettings.h"
#include "SonoStage.h"

#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"

#include <utility>

vtkStandardNewMacro(vtkSonoBMode);

vtkSonoBMode::vtkSonoBMode()
  : Parameters(new sono::SettingsOf<sono::BModeSettings>)
  , Simulator(new sono::Simulator)
{
  this->SetProgressText("Making grey");
}

vtkSonoBMode::~vtkSonoBMode() = default;

void vtkSonoBMode::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->Parameters->print(os, indent);
  os << indent << "GreyMap: " << this->GreyMap << endl;
  os << indent << "GreyMapFile: " << this->GreyMapFile << endl;
}

sono::BModeSettings vtkSonoBMode::Settings(const sono::ProbeSettings& probe) const
{
  sono::BModeSettings settings = sono::settingsIn<sono::BModeSettings>(std::as_const(*this->Parameters));
  settings.frequencyMHz = probe.receivedMHz();
  settings.pulseSigmaMm = sono::pulseSigmaMm(probe.receivedMHz(), probe.receivedBandwidth());
  settings.hazeGrowthPerMm =
    sono::bodyWallGrowthPerMm(probe.imagingMode, probe.centreFrequencyMHz, probe.facePressureKPa);
  settings.linesAcross = probe.geometry.lineCount;
  settings.shownPerRange = probe.geometry.shownPerRange();
  if (this->GreyMapFile.empty() && this->GreyMap == "Linear")
  {
    return settings;
  }
  const std::string path =
    this->GreyMapFile.empty() ? sono::dataFileCalled(this->GreyMap, "grey_maps", ".csv") : this->GreyMapFile;
  if (path.empty())
  {
    throw sono::Error("There is no grey map '" + this->GreyMap +
                      "'; set GreyMap to Linear, Square Root or S-Shaped, or GreyMapFile to a table of your own.");
  }
  if (path != this->GreyTablePath)
  {
    this->GreyTable = sono::readGreyMap(path);
    this->GreyTablePath = path;
  }
  settings.greyMap = this->GreyTable;
  return settings;
}

int vtkSonoBMode::RequestInformation(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    // Extent, origin and spacing are the input's, which the pipeline has copied.
    vtkInformation* outInfo = output->GetInformationObject(0);
    sono::announceSameFields(input[0]->GetInformationObject(0), outInfo);
  });
}

int vtkSonoBMode::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  return sono::requestWholeImage(input);
}

int vtkSonoBMode::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    vtkImageData* lines = vtkImageData::GetData(input[0]);
    const sono::ProbeField probe = sono::readProbe(lines->GetFieldData());
    const sono::LineImageLayout layout = sono::lineImageLayout(lines, probe.geometry.totalLineCount());
    const sono::BModeSettings settings = this->Settings(probe);
    sono::writeGreySettings(settings, vtkImageData::GetData(output)->GetFieldData());
    if (const sono::RfResult rf = sono::rfOf(lines))
    {
      return sono::fillBMode(this->Simulator->makeBMode(rf, settings), probe, vtkImageData::GetData(output));
    }
    const std::vector<float> envelope =
      sono::lineValues("Envelope", lines->GetPointData(), std::size_t(layout.lineCount) * layout.sampleCount);
    sono::fillBMode(sono::BModeResult(sono::makeBMode(envelope, layout.lineCount, layout.sampleCount,
                                                      sono::rangeSampleMm(probe.geometry, layout), settings)),
                    probe, vtkImageData::GetData(output));
  });
}
