#pragma once

#include <map>
#include <string>

namespace sono {

/// What the slider of a property offers, where that is less than what the property takes: as on a scanner. All else
/// that is valid can be typed. By the names of properties; those that are not here have a slider over all that is
/// valid.
struct SliderRange
{
  double low;
  double high;
};

inline const std::map<std::string, SliderRange>& sliderRanges()
{
  static const std::map<std::string, SliderRange> ranges{
    { "ApertureMm", { 0, 100 } },
    { "AttenuationDbPerCmMHz", { 0, 5 } },
    { "AxialSmoothingMm", { 0, 5 } },
    { "CentreFrequencyMHz", { 1, 20 } },
    { "ChannelSamplingMHz", { 0, 100 } },
    { "ClosingMm", { 0, 100 } },
    { "CoherenceMm", { 0, 200 } },
    { "DepthMm", { 20, 300 } },
    { "DetailDbPer100Hu", { 0, 20 } },
    { "DynamicRangeDb", { 20, 100 } },
    { "ElementCount", { 0, 512 } },
    { "ElementWidthMm", { 0, 2 } },
    { "ElevationApertureMm", { 0, 40 } },
    { "ElevationFocusMm", { 0, 300 } },
    { "ElevationLineCount", { 1, 128 } },
    { "ElevationSectorDeg", { 10, 120 } },
    { "ElevationalSigmaMm", { 0.1, 5 } },
    { "FacePressureKPa", { 100, 3000 } },
    { "GainDb", { -40, 40 } },
    { "HazeDb", { -200, 0 } },
    { "HazeFallDbPerCmMHz", { 0, 5 } },
    { "KerfMm", { 0, 0.5 } },
    { "LateralSigmaMm", { 0.1, 5 } },
    { "LateralSmoothingLines", { 0, 8 } },
    { "LineCount", { 16, 512 } },
    { "MaxCollisions", { 0, 50 } },
    { "NoiseDb", { -200, 0 } },
    { "PathsPerLine", { 1, 4096 } },
    { "RadiusMm", { 5, 100 } },
    { "RejectDb", { 0, 60 } },
    { "RouletteDb", { -200, 0 } },
    { "SamplingMHz", { 0, 200 } },
    { "ScattererCellMm", { 0.05, 2 } },
    { "ScattererLevelDb", { -40, 40 } },
    { "SectorDeg", { 10, 120 } },
    { "TargetErrorDb", { 0, 3 } },
    { "TgcDbPerCm", { 0, 10 } },
    { "TimeBudgetS", { 0, 60 } },
    { "TransmitCount", { 1, 128 } },
    { "TransmitDistanceMm", { 0, 300 } },
    { "TransmitFocusMm", { 0, 300 } },
    { "WallMm", { 0, 50 } },
    { "WidthMm", { 10, 100 } },
  };
  return ranges;
}

} // namespace sono
