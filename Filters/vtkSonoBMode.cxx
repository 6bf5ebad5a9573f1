#include "vtkSonoBMode.h"

#include "Image/BMode.h"
#include "Simulator.h"
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
  os << indent << "TgcPoints (mm, dB):";
  for (const auto& [depthMm, gainDb] : this->Settings().tgcCurve)
  {
    os << " (" << depthMm << ", " << gainDb << ")";
  }
  os << endl;
}

const sono::BModeSettings& vtkSonoBMode::Settings() const
{
  return sono::settingsIn<sono::BModeSettings>(std::as_const(*this->Parameters));
}

void vtkSonoBMode::AddTgcPoint(double depthMm, double gainDb)
{
  sono::settingsIn<sono::BModeSettings>(*this->Parameters).tgcCurve.emplace_back(depthMm, gainDb);
  this->Modified();
}

void vtkSonoBMode::RemoveAllTgcPoints()
{
  if (this->GetNumberOfTgcPoints() > 0)
  {
    sono::settingsIn<sono::BModeSettings>(*this->Parameters).tgcCurve.clear();
    this->Modified();
  }
}

int vtkSonoBMode::GetNumberOfTgcPoints() const
{
  return static_cast<int>(this->Settings().tgcCurve.size());
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
    if (const sono::RfResult rf = sono::rfOf(lines))
    {
      return sono::fillBMode(this->Simulator->makeBMode(rf, this->Settings()), vtkImageData::GetData(output));
    }
    const std::vector<float> envelope =
      sono::lineValues("Envelope", lines->GetPointData(), std::size_t(layout.lineCount) * layout.sampleCount);
    sono::fillBMode(sono::BModeResult(sono::makeBMode(envelope, layout.lineCount, layout.sampleCount, layout.sampleMm,
                                                      this->Settings())),
                    vtkImageData::GetData(output));
  });
}
