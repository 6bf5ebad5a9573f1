// The filters' defaults are the simulation's: both are typed by hand, once for VTK's macros and once in the settings.
//
// Each test takes its settings apart by name, which compiles only while every member has one. So a new member stops the
// build here: give it a property in the filter's header, PrintSelf, XML and .cxx, and compare its default below.
#include "Core/SoundSpeed.h"
#include "Echo/FormRf.h"
#include "Image/BMode.h"
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
#include "vtkSonoImageFormation.h"
#include "vtkSonoPhantomSource.h"
#include "vtkSonoProbeSource.h"
#include "vtkSonoPulseEchoField.h"
#include "vtkSonoRayTracer.h"
#include "vtkSonoSceneBuilder.h"
#include "vtkSonoThoraxSource.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

constexpr double degrees = 57.29577951308232;

TEST(FilterDefaults, RayTracerEqualsTraceSettings)
{
  const auto [device, march, model, sampling, pathsPerLine, maxCollisions, coherenceMm, deterministic, lobeMeanRad,
              lobeSigmaRad, lobeMinRad, lobeMaxRad, frequencyMHz, depthMm, radialBinMm, echoSampleMm, rouletteDb, seed,
              interactive] = sono::TraceSettings();
  vtkNew<vtkSonoRayTracer> tracer;
  EXPECT_EQ(tracer->GetDevice(), static_cast<int>(device));
  EXPECT_EQ(tracer->GetInterfaceModel(), static_cast<int>(model));
  EXPECT_EQ(tracer->GetSampling(), static_cast<int>(sampling));
  EXPECT_EQ(tracer->GetPathsPerLine(), pathsPerLine);
  EXPECT_EQ(tracer->GetMaxCollisions(), maxCollisions);
  EXPECT_EQ(tracer->GetCoherenceMm(), coherenceMm);
  EXPECT_EQ(tracer->GetDeterministic(), deterministic);
  // The settings write pi/4 and pi/2 with six decimals, the filter 45 and 90 degrees.
  EXPECT_NEAR(tracer->GetLobeMeanDeg(), lobeMeanRad * degrees, 1e-4);
  EXPECT_NEAR(tracer->GetLobeSigmaDeg(), lobeSigmaRad * degrees, 1e-4);
  EXPECT_NEAR(tracer->GetLobeMinDeg(), lobeMinRad * degrees, 1e-4);
  EXPECT_NEAR(tracer->GetLobeMaxDeg(), lobeMaxRad * degrees, 1e-4);
  EXPECT_EQ(tracer->GetRadialBinMm(), radialBinMm);
  EXPECT_NEAR(sono::assumedSoundSpeedMmPerUs / (2.0 * tracer->GetSamplingMHz()), echoSampleMm, 1e-12);
  EXPECT_EQ(tracer->GetRouletteDb(), rouletteDb);
  EXPECT_EQ(static_cast<std::uint64_t>(tracer->GetSeed()), seed);
  // The probe sets these two.
  EXPECT_EQ(vtkNew<vtkSonoProbeSource>()->GetCentreFrequencyMHz(), frequencyMHz);
  EXPECT_EQ(vtkNew<vtkSonoProbeSource>()->GetDepthMm(), depthMm);
  EXPECT_FALSE(interactive); // the probe says when it is on its way
  // The filter offers no choice of the march: both give the same image, and this is the fast one.
  EXPECT_EQ(march, sono::March::RegionCache);
}

TEST(FilterDefaults, ImageFormationEqualsEchoSettings)
{
  const auto [device, centreFrequencyMHz, fractionalBandwidth, samplingMHz, depthMm, lateralSigmaMm, elevationalSigmaMm,
              field, pulse, scattererCellMm, scattererLevelDb, seed] = sono::EchoSettings();
  vtkNew<vtkSonoImageFormation> formation;
  EXPECT_EQ(formation->GetDevice(), static_cast<int>(device));
  EXPECT_EQ(formation->GetLateralSigmaMm(), lateralSigmaMm);
  EXPECT_EQ(formation->GetElevationalSigmaMm(), elevationalSigmaMm);
  EXPECT_EQ(formation->GetScattererCellMm(), scattererCellMm);
  EXPECT_EQ(formation->GetScattererLevelDb(), scattererLevelDb);
  EXPECT_EQ(static_cast<std::uint64_t>(formation->GetSeed()), seed);
  // Nothing is connected and no file named.
  EXPECT_EQ(field, nullptr);
  EXPECT_EQ(formation->GetNumberOfInputConnections(2), 0);
  EXPECT_EQ(pulse, nullptr);
  EXPECT_STREQ(formation->GetPulseFileName(), "");
  // The tracer sets the sampling, the probe the rest.
  EXPECT_EQ(vtkNew<vtkSonoRayTracer>()->GetSamplingMHz(), samplingMHz);
  vtkNew<vtkSonoProbeSource> probe;
  EXPECT_EQ(probe->GetCentreFrequencyMHz(), centreFrequencyMHz);
  EXPECT_EQ(probe->GetFractionalBandwidth(), fractionalBandwidth);
  EXPECT_EQ(probe->GetDepthMm(), depthMm);
}

TEST(FilterDefaults, PulseEchoFieldEqualsArrayAperture)
{
  const auto [elementCount, elementWidthMm, elementHeightMm, kerfMm, faceRadiusMm, transmitFocusMm, elevationFocusMm,
              apodization, centreFrequencyMHz, fractionalBandwidth, attenuationDbPerCmMHz, soundSpeedMmPerUs] =
    sono::ArrayAperture();
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
  // The filter offers no choice of the sound speed, which is that of the echoes' depths.
  EXPECT_EQ(soundSpeedMmPerUs, sono::assumedSoundSpeedMmPerUs);
}

TEST(FilterDefaults, BModeEqualsBModeSettings)
{
  const auto [tgcDbPerCm, tgcCurve, gainDb, automaticReference, referenceAmplitude, dynamicRangeDb, rejectDb, greyMap,
              noiseDb, noiseSeed] = sono::BModeSettings();
  vtkNew<vtkSonoBMode> bmode;
  EXPECT_EQ(bmode->GetTgcDbPerCm(), tgcDbPerCm);
  EXPECT_EQ(bmode->GetNumberOfTgcPoints(), static_cast<int>(tgcCurve.size()));
  EXPECT_EQ(bmode->GetGainDb(), gainDb);
  EXPECT_EQ(bmode->GetAutomaticReference(), automaticReference);
  EXPECT_EQ(bmode->GetReferenceAmplitude(), referenceAmplitude);
  EXPECT_EQ(bmode->GetDynamicRangeDb(), dynamicRangeDb);
  EXPECT_EQ(bmode->GetRejectDb(), rejectDb);
  EXPECT_EQ(bmode->GetGreyMap(), static_cast<int>(greyMap));
  EXPECT_EQ(bmode->GetAddNoise(), std::isfinite(noiseDb));
  EXPECT_EQ(static_cast<std::uint64_t>(bmode->GetNoiseSeed()), noiseSeed);
}

TEST(FilterDefaults, ProbeEqualsScanGeometry)
{
  const auto [kind, lineCount, depthMm, sectorDeg, radiusMm, widthMm, elevationLineCount, elevationSectorDeg] =
    sono::ScanGeometry();
  vtkNew<vtkSonoProbeSource> probe;
  EXPECT_EQ(probe->GetScanKind(), static_cast<int>(kind));
  EXPECT_EQ(probe->GetLineCount(), lineCount);
  EXPECT_EQ(probe->GetDepthMm(), depthMm);
  EXPECT_EQ(probe->GetSectorDeg(), sectorDeg);
  EXPECT_EQ(probe->GetRadiusMm(), radiusMm);
  EXPECT_EQ(probe->GetWidthMm(), widthMm);
  EXPECT_EQ(probe->GetElevationLineCount(), elevationLineCount);
  EXPECT_EQ(probe->GetElevationSectorDeg(), elevationSectorDeg);
}

TEST(FilterDefaults, SceneBuilderEqualsBodyFillSettings)
{
  const auto [closingMm, wallMm, skinMm] = sono::BodyFillSettings();
  vtkNew<vtkSonoSceneBuilder> builder;
  EXPECT_EQ(builder->GetClosingMm(), closingMm);
  EXPECT_EQ(builder->GetWallMm(), wallMm);
  EXPECT_EQ(builder->GetSkinMm(), skinMm);
  EXPECT_FALSE(builder->GetFillBody());
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
