#pragma once

#include <string>
#include <vector>

namespace sono {

struct CsvFile;

/// Acoustic and scattering properties of one tissue.
struct Tissue
{
  std::string name;
  double impedanceMRayl = 1.5;        ///< in [1e-4, 1e4]
  double soundSpeedMPerS = 1540.0;    ///< in [10, 1e5]
  double attenuationDbPerCmMHz = 0.5; ///< >= 0; amplitude decibels, one way
  double scattererMean = 0.0;         ///< mu0 in [0, 1]
  double scattererSigma = 0.0;        ///< sigma0 in [0, 1]
  double scattererProbability = 0.0;  ///< mu1 in [0, 1]
  double tau = 1.0;                   ///< exponent of the intensity in a boundary echo, in [0, 3]; 1 is neutral
  double gamma = 0.0;                 ///< exponent of cos(theta) in a boundary echo, in [-2, 2]; 0 is neutral
  double roughnessMm = 0.1;           ///< rms height of its surface, in [0, 10]; of two tissues the rougher counts
  double correlationMm = 1.0;         ///< correlation length of that height, in [0.01, 100]
  double backscatterPerCmSr = 1e-4;   ///< b1 of mu_b = b1 (f / MHz)^n, across its fibres, in [0, 1]; 1/(cm sr)
  double backscatterExponent = 1.4;   ///< n, in [0, 6]
  double fibreAnisotropyDb = 0.0;     ///< how much stronger across its fibres than along them, in [0, 60]
  double nonlinearity = 4.5;          ///< beta = 1 + B/(2A), in [0, 20]: what the second harmonic grows by
  std::string source;                 ///< where the numbers come from
};

/// One number of a tissue and its column in a table.
struct TissueColumn
{
  const char* name;
  double Tissue::*member;
  const char* meaning; ///< a sentence with unit and range
};

/// In the order of the table.
const std::vector<TissueColumn>& tissueColumns();

/// Throws Error naming the tissue and the column for a number that is not finite or out of its range.
void checkRanges(const Tissue& tissue);

/// Tissues by name. The table is a CSV file that a person may edit.
class TissueTable
{
public:
  /// Columns, in any order, by header: tissue, impedance_MRayl, sound_speed_m_per_s, attenuation_dB_per_cm_MHz,
  /// mu0, sigma0, mu1, tau, gamma, source; and, with the defaults above where a table lacks them, roughness_mm,
  /// correlation_mm, backscatter_1MHz_per_cm_sr, backscatter_exponent, fibre_anisotropy_dB, nonlinearity. Lines
  /// starting with '#' are comments; fields may be quoted. Throws Error naming the file, the tissue and the column for
  /// a missing, non-finite or out-of-range number.
  static TissueTable read(const std::string& path);
  /// The same of a table's text, whose name stands for the file's in messages.
  static TissueTable parse(const std::string& text, const std::string& name);

  /// Checks the ranges above and that the name is new; throws Error naming the tissue.
  void add(const Tissue& tissue);
  const Tissue* find(const std::string& name) const;
  const std::vector<Tissue>& tissues() const { return tissues_; }

private:
  static TissueTable of(const CsvFile& csv);

  std::vector<Tissue> tissues_;
};

/// Of the intensity, which falls by 10^(-a f l / 10), l in cm: k in exp(-k l), 1/mm.
double decayPerMm(const Tissue& tissue, double frequencyMHz);

/// mu_b at a frequency, 1/(mm sr) (Data/docs/physics.md eq. 11.1).
double backscatterPerMmSr(const Tissue& tissue, double frequencyMHz);

} // namespace sono
