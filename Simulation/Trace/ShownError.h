#pragma once

#include "Trace/Deposit.h"
#include "Trace/Trace.h"

#include <complex>
#include <vector>

// How exact a picture of traced lines is, in dB, where it is not black: what a target error is held against.

namespace sono {

/// Levels along lines in cells about as long as a picture's resolution, and their standard errors, both amplitudes as
/// TracedLines::intensity and reverberation: the sum of these and of the boundary echoes that reverberate. A cell's
/// error is the mean of its bins', which the same paths cross.
struct ShownCells
{
  int lineCount = 0;
  int cellCount = 0; ///< to the depth of the image
  int binsEach = 1;
  double cellMm = 1.0;
  std::vector<float> level; ///< lineCount x cellCount, as the next
  std::vector<float> error;
};

/// Boundary echoes in the same cells: the amplitude of their sum with all phases, and its standard error, both against
/// speckle of level 1 (boundaryPerSpeckle). Empty: there are none.
struct EchoCells
{
  std::vector<float> level;
  std::vector<float> error;
};

/// Without their levels.
ShownCells cellLayout(const TracedLines& traced);

/// Of a line's echoes by so many paths. Each path adds an amplitude a at a phase; the sum S / N of N has the variance
/// (sum of a^2 - |S|^2 / N) / N^2, an upper bound where paths are spread more evenly than by chance. `radPerMm` is that
/// of their phases (2 k).
void fillEchoCells(const TracedLines& traced, const LineEchoes& echoes, int line, int paths, double radPerMm,
                   const ShownCells& layout, EchoCells& cells);
/// Of a line, with what its echoes left, if anything.
void fillCells(const TracedLines& traced, const EchoCells& echoes, int line, ShownCells& cells);

/// Squared standard errors in dB, summed over the cells that are shown, of each line, and how many these are.
///
/// Shown is what a picture has above black: levels, gained by 5 dB/cm and averaged over two lines to either side, less
/// than 60 dB below 25 dB above their 90th percentile (BModeSettings as it comes; speckle of all tissues alike). An
/// error is 20/ln 10 times the standard error over the level, or over that of black where that is more, at most that of
/// 100 %. Few paths often miss the few that
/// carry much and then report too little error; so lines take the mean variance, of one path, of two lines to either
/// side.
struct LineErrors
{
  std::vector<double> squaredDb;
  std::vector<int> shown;

  double rmsDb() const; ///< 0 where nothing is shown
};
LineErrors lineErrors(const ShownCells& cells, const std::vector<int>& paths);

/// The lines, ascending, whose paths are to be doubled to come to the target soonest: those with the largest squared
/// error a path, until the sum would be low enough if doubling halved it; none when it is. Lines with more than half of
/// `mostPaths` are left alone.
std::vector<int> linesToDouble(const LineErrors& errors, const std::vector<int>& paths, int mostPaths, double targetDb);

/// Of traced lines, without what the echoes' own errors add.
double shownErrorDb(const TracedLines& traced);

} // namespace sono
