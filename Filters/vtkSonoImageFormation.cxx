#include "vtkSonoImageFormation.h"

#include "Echo/FormRf.h"
#include "SonoFieldImage.h"
#include "SonoLineImage.h"
#include "SonoProbeField.h"
#include "SonoSettings.h"
#include "SonoStage.h"
#include "vtkSonoSceneHandle.h"

#include "vtkDataArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"

#include <algorithm>
#include <optional>
#include <type_traits>

vtkStandardNewMacro(vtkSonoImageFormation);

namespace {

constexpr double previewCell = 2.0; // of the cell's edge that is set
constexpr double widestCellMm = 10.0;

sono::TracedLines tracedLines(vtkImageData* image, const sono::ProbeField& probe, double echoSampleMm)
{
  const sono::LineImageLayout layout = sono::lineImageLayout(image, probe.geometry.totalLineCount());
  const std::size_t count = std::size_t(layout.lineCount) * layout.sampleCount;
  sono::TracedLines traced;
  traced.lineCount = layout.lineCount;
  traced.binCount = layout.sampleCount;
  traced.binMm = layout.sampleMm;
  sono::TracedLines::visitArrays(traced, [&](auto& values, const char* name, sono::TracedAxis axis) {
    vtkFieldData* from = axis == sono::TracedAxis::Bins ? image->GetPointData() : image->GetFieldData();
    if constexpr (std::is_same_v<std::decay_t<decltype(values)>, std::vector<float>>)
    {
      values = sono::lineValues(name, from, count);
    }
    else
    {
      values = sono::complexLineValues(name, from);
    }
  });
  traced.echoCount = static_cast<int>(traced.boundaryEcho.size() / layout.lineCount);
  traced.echoSampleMm = echoSampleMm;
  return traced;
}

/// Nothing where no scatterers are connected.
std::optional<sono::PointScatterers> pointScatterers(vtkPointSet* points)
{
  if (!points || points->GetNumberOfPoints() == 0)
  {
    return std::nullopt;
  }
  vtkDataArray* amplitude = points->GetPointData()->GetArray("Amplitude");
  if (!amplitude || amplitude->GetNumberOfComponents() != 1)
  {
    throw sono::Error("The scatterers have no point array 'Amplitude' with one component; add it, for example with a "
                      "Calculator.");
  }
  std::vector<sono::PointScatterer> scatterers(static_cast<std::size_t>(points->GetNumberOfPoints()));
  for (std::size_t i = 0; i < scatterers.size(); ++i)
  {
    const auto id = static_cast<vtkIdType>(i);
    points->GetPoint(id, &scatterers[i].positionMm.x);
    scatterers[i].amplitude = static_cast<float>(amplitude->GetTuple1(id));
  }
  return sono::PointScatterers(scatterers);
}

} // namespace

vtkSonoImageFormation::vtkSonoImageFormation()
  : Parameters(new sono::SettingsOf<sono::EchoSettings>)
{
  this->SetNumberOfInputPorts(3);
  this->SetProgressText("Forming echoes");
}

vtkSonoImageFormation::~vtkSonoImageFormation() = default;

void vtkSonoImageFormation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->Parameters->print(os, indent);
  os << indent << "PulseFileName: " << this->PulseFileName << endl;
}

int vtkSonoImageFormation::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 1 ? "vtkPointSet" : "vtkImageData");
  if (port > 0)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

sono::EchoSettings vtkSonoImageFormation::Settings(vtkFieldData* acquisition) const
{
  const sono::ProbeField probe = sono::readProbe(acquisition);
  auto settings = sono::settingsIn<sono::EchoSettings>(*this->Parameters);
  settings.centreFrequencyMHz = probe.centreFrequencyMHz;
  settings.fractionalBandwidth = probe.fractionalBandwidth;
  settings.samplingMHz = sono::readNumber("SamplingMHz", acquisition);
  settings.depthMm = probe.geometry.depthMm;
  if (probe.preview)
  {
    settings.scattererCellMm =
      std::min(previewCell * settings.scattererCellMm, std::max(settings.scattererCellMm, widestCellMm));
  }
  settings.validate();
  return settings;
}

int vtkSonoImageFormation::RequestInformation(vtkInformation*, vtkInformationVector** input,
                                              vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    vtkFieldData* acquisition = sono::announcedFields(input[0]->GetInformationObject(0));
    const sono::EchoSettings settings = this->Settings(acquisition);
    const int lineCount = sono::readProbe(acquisition).geometry.totalLineCount();
    vtkInformation* outInfo = output->GetInformationObject(0);
    sono::announceLineImage({ settings.sampleCount(), lineCount, 0.0, settings.sampleMm() }, 1, outInfo);
    sono::announceFields(acquisition, outInfo);
  });
}

int vtkSonoImageFormation::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  sono::requestWholeImage(input, 2);
  return sono::requestWholeImage(input);
}

int vtkSonoImageFormation::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    vtkImageData* input0 = vtkImageData::GetData(input[0]);
    const sono::ProbeField probe = sono::readProbe(input0->GetFieldData());
    sono::EchoSettings settings = this->Settings(input0->GetFieldData());
    sono::announceDevice(sono::chooseDevice(settings.device));
    if (vtkImageData* field = vtkImageData::GetData(input[2]))
    {
      settings.field = std::make_shared<const sono::PulseEchoField>(sono::fieldFromImage(field));
    }
    if (!this->PulseFileName.empty())
    {
      settings.pulse = std::make_shared<const sono::SampledPulse>(sono::readPulse(this->PulseFileName));
    }
    const auto scene = vtkSonoSceneHandle::Get(input0->GetFieldData());
    const sono::TracedLines traced = tracedLines(input0, probe, settings.sampleMm());
    const auto points = pointScatterers(vtkPointSet::GetData(input[1]));
    const sono::EchoSources sources{ scene.get(), &traced, points ? &*points : nullptr };
    const sono::RfLines lines =
      sono::formRf(sources, sono::makeScanLines(probe.geometry, probe.pose), settings, sono::progressOf(this));

    vtkImageData* image = vtkImageData::GetData(output);
    sono::setLineImageLayout({ lines.sampleCount, lines.lineCount, 0.0, lines.sampleMm }, image);
    image->GetPointData()->SetScalars(sono::lineArray("Envelope", lines.envelope()));
    image->GetPointData()->AddArray(sono::lineArray("RF", lines.rf()));
    image->GetPointData()->AddArray(sono::lineArray("IQ", lines.iq));
    image->GetFieldData()->RemoveArray("BoundaryEcho"); // it came along from the input and is part of RF now
  });
}
