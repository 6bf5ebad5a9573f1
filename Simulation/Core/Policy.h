#pragma once

#include <algorithm>
#include <cstddef>

// What an image leaves out while its probe is being moved, and how much memory is kept for what comes next.

namespace sono {

/// While the probe moves every line across the image is scanned or every second one: a sector of fewer than 60 lines
/// falls apart.
inline int interactiveLinesApart(int lineCount)
{
  return lineCount >= 120 ? 2 : 1;
}

/// Most paths of a line while the probe moves: of 24 the streaks of their noise show. A GPU, which leaves nothing else
/// out, takes 3 ms for as many as it has.
constexpr int interactivePaths = 40;
constexpr int interactiveDevicePaths = 1000;

/// Paths fainter than this, in dB, play Russian roulette: most of what they take is time past their first reflection,
/// where they are that faint, and what they leave stays the same in the mean. From -30 on its noise shows.
inline double interactiveRouletteDb(double rouletteDb)
{
  return std::max(rouletteDb, -40.0);
}

/// Width of a sample of the intensity.
inline double interactiveBinMm(double binMm)
{
  return 2.0 * binMm;
}

/// Sampling of the RF: four samples a period carry the usual bandwidths.
inline double interactiveSamplingMHz(double samplingMHz, double centreFrequencyMHz)
{
  return std::min(samplingMHz, 4.0 * centreFrequencyMHz);
}

/// Edge of a scatterer's cell: twice as wide, as far as that may be (10 mm).
inline double interactiveCellMm(double cellMm)
{
  return std::min(2.0 * cellMm, std::max(cellMm, 10.0));
}

/// Candidates in a resolution cell: one and a half are enough for speckle that will be gone in a moment.
inline double interactiveCandidates(double candidatesPerCell)
{
  return 0.25 * candidatesPerCell;
}

/// Of the scatterers of moving tissue, which do not follow the resolution cell.
constexpr double interactiveMovingShare = 0.2;

/// Surfaces are cut into pieces of this edge, as they are anyway where voxels are as large: a piece costs the same.
constexpr double interactivePieceMm = 2.0;

/// Of the points of a piece the distance: of diffuse echoes, and of the widest coherent ones, which are then up to
/// half again as wide as the beam at its focus.
constexpr double interactiveDiffuseSteps = 2.5;
constexpr double interactiveWidestSteps = 2.0;
/// And of a bent surface's coherent points, whose phases then differ by so many times more.
constexpr double interactiveTurns = 2.0;

/// While it rests, surfaces that far around its fan are made ready for it.
constexpr float foreseenMm = 40.0f;

/// Edge of a pixel: twice as wide, since ParaView looks at each pixel of each image for its ranges.
inline double interactivePixelMm(double pixelMm)
{
  return 2.0 * pixelMm;
}

/// Edge of the boxes in which the anatomy is kept for a moving probe, in voxels: the words of one take 270 MB.
constexpr int interactiveEdgeVoxels = 512;

/// Images of a sweep that go through the stages together: enough to fill a GPU, and few enough that the host takes over
/// those of one group while the next is computed. On a GPU a group takes at most this share of the memory.
constexpr int imagesTogether = 16;
constexpr double groupShareOfDeviceMemory = 0.25;

/// Freed memory that is kept for the next results: the device's, and the host's that the device writes to.
constexpr std::size_t keptDeviceBytes = std::size_t(1) << 30;
constexpr std::size_t keptPinnedBytes = std::size_t(256) << 20;

/// Scatterers of moving tissue that a simulator keeps of the phases that were shown last: of a heart those of 30 phases
/// of a moving probe's pictures, or of 6 of full ones.
constexpr std::size_t keptMovingBytes = std::size_t(256) << 20;

} // namespace sono
