#pragma once

#include <vector>

namespace sono::study {

/// How well a lesion is told from its surroundings (Data/docs/physics.md section 9).
struct Detectability
{
  double gcnr = 0.0;      ///< of the envelope: no display hides it
  double gcnrShown = 0.0; ///< of the grey levels, where what is rejected is all alike
  double cnr = 0.0;
  double contrastDb = 0.0;
};

/// gCNR: 1 - 2 x the least error with which one threshold tells the values apart (Rodriguez-Molares 2019; the seed
/// marks that threshold in its histograms). For densities that cross once, as Rayleigh's do, it is 1 - their overlap,
/// without the bias that empty bins give a histogram of few pixels.
double gcnrByThreshold(const std::vector<float>& inside, const std::vector<float>& outside);

/// 1 - overlap of two histograms of `bins` equal bins over the range of all values.
double gcnrByHistogram(const std::vector<float>& inside, const std::vector<float>& outside, int bins);

/// Contrast 20 log10(mean in / mean out) and CNR |mean in - mean out| / sqrt(var in + var out) of the envelope, gCNR of
/// the envelope and of what is shown of it.
Detectability detectability(const std::vector<float>& envelopeInside, const std::vector<float>& envelopeOutside,
                            const std::vector<float>& shownInside, const std::vector<float>& shownOutside);

/// gCNR of two regions of fully developed speckle whose mean envelopes differ by contrastDb, averaged over `looks`
/// independent pictures of power: power is gamma distributed with shape m = looks, and scale r and 1 for the power
/// ratio r. The densities cross at x = m ln r / (1 - 1/r), so gCNR = P(m, x) - P(m, x/r), with P the regularized lower
/// incomplete gamma function. One look: r^(-1/(r-1)) - r^(-r/(r-1)). `looks` > 0, a fraction where they are correlated.
double gcnrOfSpeckle(double contrastDb, double looks = 1.0);

/// gCNR of two regions whose levels are normal with one standard deviation s > 0 and means D apart, dB: the densities
/// cross half way, so it is 2 Phi(|D| / 2s) - 1.
double gcnrOfNormalLevels(double differenceDb, double deviationDb);

/// A lesion as somebody measured it.
struct MeasuredLesion
{
  double gcnr;
  double contrastDb;
};

/// The smallest mean absolute gCNR error that fully developed speckle allows when the mean absolute contrast error
/// stays within meanContrastDb: each lesion may have any contrast of its sign, and gCNR follows by gcnrOfSpeckle. By
/// dynamic programming over what the lesions may be off together, in steps of 0.01 dB.
double leastGcnrError(const std::vector<MeasuredLesion>& lesions, double meanContrastDb);

/// The mean absolute gCNR error of lesions that have their contrasts exactly, in speckle whose levels are normal.
double gcnrErrorOfNormalLevels(const std::vector<MeasuredLesion>& lesions, double deviationDb);
/// The smallest that any one standard deviation from 0.1 to 20 dB gives.
double leastGcnrErrorOfNormalLevels(const std::vector<MeasuredLesion>& lesions);
/// The smallest that speckle of any one number of looks from 1 to 200 gives.
double leastGcnrErrorOfLooks(const std::vector<MeasuredLesion>& lesions);

} // namespace sono::study
