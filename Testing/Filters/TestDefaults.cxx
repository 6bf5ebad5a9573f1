// The filters' defaults are the simulation's: both are typed by hand, once for VTK's macros and once in the settings.
#include "Echo/FormRf.h"
#include "Image/BMode.h"
#include "Probe/ScanGeometry.h"
#include "Trace/Trace.h"

#include "vtkNew.h"
#include "vtkSonoBMode.h"
#include "vtkSonoImageFormation.h"
#include "vtkSonoProbeSource.h"
#include "vtkSonoRayTracer.h"

#include <gtest/gtest.h>

namespace {

constexpr double degrees = 57.29577951308232;

TEST(FilterDefaults, RayTracerEqualsTraceSettings)
{
  const sono::TraceSettings settings;
  vtkNew<vtkSonoRayTracer> tracer;
  EXPECT_EQ(tracer->GetInterfaceModel(), static_cast<int>(settings.model));
  EXPECT_EQ(tracer->GetSampling(), static_cast<int>(settings.sampling));
  EXPECT_EQ(tracer->GetPathsPerLine(), settings.pathsPerLine);
  EXPECT_EQ(tracer->GetMaxCollisions(), settings.maxCollisions);
  EXPECT_EQ(tracer->GetCoherenceMm(), settings.coherenceMm);
  EXPECT_EQ(tracer->GetDeterministic(), settings.deterministic);
  // The settings write pi/4 and pi/2 with six decimals, the filter 45 and 90 degrees.
  EXPECT_NEAR(tracer->GetLobeMeanDeg(), settings.lobeMeanRad * degrees, 1e-4);
  EXPECT_NEAR(tracer->GetLobeSigmaDeg(), settings.lobeSigmaRad * degrees, 1e-4);
  EXPECT_NEAR(tracer->GetLobeMinDeg(), settings.lobeMinRad * degrees, 1e-4);
  EXPECT_NEAR(tracer->GetLobeMaxDeg(), settings.lobeMaxRad * degrees, 1e-4);
  EXPECT_EQ(tracer->GetRadialBinMm(), settings.radialBinMm);
  EXPECT_NEAR(sono::assumedSoundSpeedMmPerUs / (2.0 * tracer->GetSamplingMHz()), settings.echoSampleMm, 1e-12);
  EXPECT_EQ(static_cast<std::uint64_t>(tracer->GetSeed()), settings.seed);
}

TEST(FilterDefaults, ImageFormationEqualsEchoSettings)
{
  const sono::EchoSettings settings;
  vtkNew<vtkSonoImageFormation> formation;
  EXPECT_EQ(formation->GetLateralSigmaMm(), settings.lateralSigmaMm);
  EXPECT_EQ(formation->GetElevationalSigmaMm(), settings.elevationalSigmaMm);
  EXPECT_EQ(formation->GetScattererCellMm(), settings.scattererCellMm);
  EXPECT_EQ(formation->GetScattererLevelDb(), settings.scattererLevelDb);
  EXPECT_EQ(static_cast<std::uint64_t>(formation->GetSeed()), settings.seed);
  EXPECT_EQ(vtkNew<vtkSonoRayTracer>()->GetSamplingMHz(), settings.samplingMHz);
}

TEST(FilterDefaults, BModeEqualsBModeSettings)
{
  const sono::BModeSettings settings;
  vtkNew<vtkSonoBMode> bmode;
  EXPECT_EQ(bmode->GetTgcDbPerCm(), settings.tgcDbPerCm);
  EXPECT_EQ(bmode->GetNumberOfTgcPoints(), static_cast<int>(settings.tgcCurve.size()));
  EXPECT_EQ(bmode->GetGainDb(), settings.gainDb);
  EXPECT_EQ(bmode->GetAutomaticReference(), settings.automaticReference);
  EXPECT_EQ(bmode->GetReferenceAmplitude(), settings.referenceAmplitude);
  EXPECT_EQ(bmode->GetDynamicRangeDb(), settings.dynamicRangeDb);
  EXPECT_EQ(bmode->GetRejectDb(), settings.rejectDb);
}

TEST(FilterDefaults, ProbeEqualsScanGeometryPoseAndPulse)
{
  const sono::ScanGeometry geometry;
  const sono::ProbePose pose;
  const sono::EchoSettings pulse;
  vtkNew<vtkSonoProbeSource> probe;
  EXPECT_EQ(probe->GetScanKind(), static_cast<int>(geometry.kind));
  EXPECT_EQ(probe->GetLineCount(), geometry.lineCount);
  EXPECT_EQ(probe->GetDepthMm(), geometry.depthMm);
  EXPECT_EQ(probe->GetSectorDeg(), geometry.sectorDeg);
  EXPECT_EQ(probe->GetRadiusMm(), geometry.radiusMm);
  EXPECT_EQ(probe->GetWidthMm(), geometry.widthMm);
  for (int axis = 0; axis < 3; ++axis)
  {
    EXPECT_EQ(probe->GetPositionMm()[axis], pose.positionMm[axis]);
    EXPECT_EQ(probe->GetAxial()[axis], pose.axial[axis]);
    EXPECT_EQ(probe->GetLateral()[axis], pose.lateral[axis]);
  }
  EXPECT_EQ(probe->GetCentreFrequencyMHz(), pulse.centreFrequencyMHz);
  EXPECT_EQ(probe->GetCentreFrequencyMHz(), sono::TraceSettings().frequencyMHz);
  EXPECT_EQ(probe->GetFractionalBandwidth(), pulse.fractionalBandwidth);
}

} // namespace
