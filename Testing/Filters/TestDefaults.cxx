// The filters' defaults are the simulation's. The stages of the image hold the settings themselves; the phantoms and
// the pulse-echo field have defaults of their own, typed by hand. Their tests take the settings apart by name, which
// compiles only while every member has one, so that a new member stops the build here.
#include "Channels/ChannelSettings.h"
#include "Core/SoundSpeed.h"
#include "Echo/FormRf.h"
#include "Image/BMode.h"
#include "Image/DisplaySettings.h"
#include "Labels/BodyFill.h"
#include "Phantoms/CalibrationPhantom.h"
#include "Phantoms/TestObjects.h"
#include "Probe/ArrayAperture.h"
#include "Probe/ScanGeometry.h"
#include "Trace/Trace.h"

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkSonoBMode.h"
#include "vtkSonoChannelData.h"
#include "vtkSonoImageFormation.h"
#include "vtkSonoPhantomSource.h"
#include "vtkSonoProbeSource.h"
#include "vtkSonoPulseEchoField.h"
#include "vtkSonoRayTracer.h"
#include "vtkSonoScanConverter.h"
#include "vtkSonoSceneBuilder.h"
#include "vtkSonoThoraxSource.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace {

/// Each parameter of the settings is among those that a fresh filter prints, with the settings' default.
template<class Settings, class Filter>
void expectPrinted(Filter* filter)
{
  std::ostringstream stream;
  filter->Print(stream);
  const Settings defaults = {};
  sono::requireInRange(defaults);
  Settings::visit(defaults, [&](const auto& value, const sono::Parameter& parameter) {
    std::ostringstream line;
    line << sono::propertyName(parameter) << ": " << sono::numberOf(value) << "\n";
    EXPECT_NE(stream.str().find(line.str()), std::string::npos) << line.str();
    EXPECT_GT(std::string(parameter.sentence).size(), 10u);
  });
}

TEST(FilterDefaults, StagesHaveTheSettingsOfSimulation)
{
  expectPrinted<sono::TraceSettings>(vtkNew<vtkSonoRayTracer>().Get());
  expectPrinted<sono::EchoSettings>(vtkNew<vtkSonoImageFormation>().Get());
  expectPrinted<sono::ChannelSettings>(vtkNew<vtkSonoChannelData>().Get());
  expectPrinted<sono::BModeSettings>(vtkNew<vtkSonoBMode>().Get());
  expectPrinted<sono::DisplaySettings>(vtkNew<vtkSonoScanConverter>().Get());
  expectPrinted<sono::ProbeSettings>(vtkNew<vtkSonoProbeSource>().Get());
  expectPrinted<sono::BodyFillSettings>(vtkNew<vtkSonoSceneBuilder>().Get());
}

TEST(FilterDefaults, StagesAgreeOnWhatTheyShare)
{
  const sono::TraceSettings tracing;
  const sono::EchoSettings echo;
  const sono::ProbeSettings probe;
  EXPECT_EQ(vtkNew<vtkSonoRayTracer>()->GetSamplingMHz(), echo.samplingMHz);
  EXPECT_NEAR(echo.sampleMm(), tracing.echoSampleMm, 1e-12);
  EXPECT_EQ(probe.centreFrequencyMHz, tracing.frequencyMHz);
  EXPECT_EQ(probe.centreFrequencyMHz, echo.centreFrequencyMHz);
  EXPECT_EQ(probe.fractionalBandwidth, echo.fractionalBandwidth);
  EXPECT_EQ(probe.imagingMode, tracing.imagingMode);
  EXPECT_EQ(probe.imagingMode, echo.imagingMode);
  EXPECT_EQ(probe.facePressureKPa, tracing.facePressureKPa);
  EXPECT_EQ(probe.geometry.depthMm, tracing.depthMm);
  EXPECT_EQ(probe.geometry.depthMm, echo.depthMm);
}

TEST(FilterDefaults, AParameterKeepsWhatItIsGiven)
{
  vtkNew<vtkSonoRayTracer> tracer;
  const vtkMTimeType before = tracer->GetMTime();
  tracer->SetPathsPerLine(tracer->GetPathsPerLine());
  EXPECT_EQ(tracer->GetMTime(), before); // no change, no work
  tracer->SetLobeSigmaDeg(6.1);
  tracer->SetPathSeed(-3);
  tracer->SetDeterministic(true);
  EXPECT_GT(tracer->GetMTime(), before);
  EXPECT_EQ(tracer->GetLobeSigmaDeg(), 6.1);
  EXPECT_EQ(tracer->GetPathSeed(), -3);
  EXPECT_TRUE(tracer->GetDeterministic());
}

TEST(FilterDefaults, PulseEchoFieldEqualsArrayAperture)
{
  const auto [elementCount, elementWidthMm, elementHeightMm, kerfMm, faceRadiusMm, transmitFocusMm, elevationFocusMm,
              apodization, centreFrequencyMHz, imagingMode, fractionalBandwidth, attenuationDbPerCmMHz,
              soundSpeedMmPerUs, elevationCount] = sono::ArrayAperture();
  vtkNew<vtkSonoPulseEchoField> field;
  EXPECT_STREQ(field->GetFileName(), "");
  EXPECT_EQ(field->GetElementCount(), elementCount);
  EXPECT_EQ(field->GetElementWidthMm(), elementWidthMm);
  EXPECT_EQ(field->GetElementHeightMm(), elementHeightMm);
  EXPECT_EQ(field->GetKerfMm(), kerfMm);
  EXPECT_EQ(field->GetFaceRadiusMm(), faceRadiusMm);
  EXPECT_EQ(field->GetTransmitFocusMm(), transmitFocusMm);
  EXPECT_EQ(field->GetElevationFocusMm(), elevationFocusMm);
  EXPECT_EQ(field->GetApodization(), static_cast<int>(apodization));
  EXPECT_EQ(field->GetCentreFrequencyMHz(), centreFrequencyMHz);
  EXPECT_EQ(field->GetAttenuationDbPerCmMHz(), attenuationDbPerCmMHz);
  // The settings have one frequency, the filter the preset's band, which TestField.py compares.
  EXPECT_EQ(fractionalBandwidth, 0.0);
  EXPECT_EQ(imagingMode, sono::ImagingMode::Fundamental);
  EXPECT_EQ(elevationCount, 1); // the filter's is an array with a lens
  // The filter offers no choice of the sound speed, which is that of the echoes' depths.
  EXPECT_EQ(soundSpeedMmPerUs, sono::assumedSoundSpeedMmPerUs);
}

TEST(FilterDefaults, PhantomSourceEqualsItsSettings)
{
  vtkNew<vtkSonoPhantomSource> source;
  const auto [spacingMm, thicknessMm, viewPitchMm, wiresAsVoxels] = sono::CalibrationPhantomSettings();
  EXPECT_EQ(source->GetSpacingMm(), spacingMm);
  EXPECT_EQ(source->GetThicknessMm(), thicknessMm);
  EXPECT_EQ(source->GetViewPitchMm(), viewPitchMm);
  EXPECT_EQ(source->GetWiresAsVoxels(), wiresAsVoxels);
  const auto [objectSpacingMm, diameterMm, depthMm] = sono::TestObjectSettings();
  EXPECT_EQ(source->GetSpacingMm(), objectSpacingMm);
  EXPECT_EQ(source->GetSphereDiameterMm(), diameterMm);
  EXPECT_EQ(source->GetSphereDepthMm(), depthMm);
}

/// The probe's own numbers are rounded; half a millimetre further out would be outside the skin.
TEST(FilterDefaults, ProbeStandsAtTheThoraxsApicalView)
{
  vtkNew<vtkSonoThoraxSource> thorax;
  thorax->SetSpacingMm(5.0);
  thorax->Update();
  vtkFieldData* field = thorax->GetOutput()->GetFieldData();
  vtkNew<vtkSonoProbeSource> probe;
  for (int axis = 0; axis < 3; ++axis)
  {
    EXPECT_NEAR(probe->GetPositionMm()[axis], field->GetArray("A4CPositionMm")->GetComponent(0, axis), 0.05);
    EXPECT_NEAR(probe->GetAxial()[axis], field->GetArray("A4CAxial")->GetComponent(0, axis), 1e-3);
    EXPECT_NEAR(probe->GetLateral()[axis], field->GetArray("A4CLateral")->GetComponent(0, axis), 1e-3);
  }
}

} // namespace
