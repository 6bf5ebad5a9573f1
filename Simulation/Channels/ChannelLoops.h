#pragma once

#include "Kernel/ChannelWave.h"

#include <vector>

namespace sono {

/// So many points go through the loop together, a vector of them.
constexpr int channelBlock = 16;
/// So many frequencies, over which E is a ComplexCurve.
constexpr int channelBins = 16;

/// What the loop over a block of points needs; nothing is owned. Arrays of elements are padded to whole vectors.
struct ChannelChunk
{
  const float *pieceX, *pieceZ, *pieceNormalX, *pieceNormalZ; ///< by piece of an element, then by element
  int elements;
  int padded;
  int perElement;
  float halfWidthMm;
  bool isSoft;
  bool isFlat;
  float shortestMm;
  float npPerMmMHz;
  ElementShape shape;
  float firstMHz; ///< of `bins` frequencies, at most channelBins
  float stepMHz;
  float centreMHz;
  int bins;
  int transmits;
  const float* drive; ///< bins x transmits x (re, im of padded elements)
};

/// A block of points; those that only fill it up have amplitude 0.
struct ChannelBlock
{
  float x[channelBlock], y[channelBlock], z[channelBlock];
  float re[channelBlock], im[channelBlock], lagMm[channelBlock], sinkNp[channelBlock], rise[channelBlock];
};

/// Room for a block, used again.
struct ChannelRoom
{
  std::vector<float> waveRe, waveIm, stepRe, stepIm; ///< by point, piece and element: G without E, and what it takes
                                                     ///< to the next frequency
  std::vector<float> across2;                        ///< the same: (w sin t / 2)^2
  std::vector<float> perRange;                       ///< by point and element: where 1/r lies in its span
  std::vector<float> heardRe, heardIm;               ///< by point and element: G

  ChannelRoom(int padded, int perElement);
};

/// Adds a block's echoes to the sums, bins x transmits x (re, im of padded elements).
void addBlock(const ChannelChunk& chunk, const ChannelBlock& block, ChannelRoom& room, float* sums);

} // namespace sono
