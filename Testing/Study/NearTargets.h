#pragma once

#include "Image/ScanConvert.h"
#include "Phantoms/PhantomTargets.h"

#include <string>
#include <vector>

namespace sono::study {

/// Speckle of plain gel: standard deviation of the levels, and full widths at half maximum of their autocorrelation.
struct GelSpeckle
{
  double deviationDb = 0.0;
  double lateralMm = 0.0;
  double axialMm = 0.0;
};

/// Of a square of a picture whose levels from 0 to 1 are `rangeDb` apart, after the plane that fits it best was taken
/// off. The square lies inside the picture.
GelSpeckle gelSpeckle(const PlaneImage& image, double rangeDb, double lateralMm, double depthMm, double sideMm);

/// How far from its brightest pixel, within 0.7 mm of its place, a wire's echo falls by 6 dB, to both sides, along the
/// depth or across it. What does not fall within 3 mm adds nothing.
double wireWidthMm(const PlaneImage& image, double rangeDb, const PhantomTarget& wire, bool axial);

/// A mass against plain gel at the same depth.
struct MassFigures
{
  std::string name;
  double levelDb = 0.0; ///< difference of the mean levels
  double gcnr = 0.0;
};

/// What two pictures of the targets in phantom_040gse_near.csv say, of the places that their table has.
struct NearFigures
{
  std::vector<MassFigures> masses; ///< but the anechoic cylinders, in the table's order
  MassFigures anechoic;            ///< their mean
  GelSpeckle speckle;              ///< of that gel
  double wireLateralMm = 0.0;      ///< mean of all wires
  double wireAxialMm = 0.0;
  double wirePeakDb = 0.0; ///< of their brightest pixels, to the plain gel beside the masses
};

/// The views 1 and 2, both with levels from 0 to 1 that are `rangeDb` apart.
NearFigures nearFigures(const std::vector<PhantomTarget>& targets, const PlaneImage& masses, const PlaneImage& wires,
                        double rangeDb);

/// Mean level of the plain gel beside the masses, above black.
double gelAboveBlackDb(const PlaneImage& masses, double rangeDb);

/// The mean over pictures, and of each mass's gCNR the standard deviation between them.
struct NearMean
{
  NearFigures mean;
  std::vector<double> gcnrDeviation;
};
NearMean meanOf(const std::vector<NearFigures>& pictures);

} // namespace sono::study
