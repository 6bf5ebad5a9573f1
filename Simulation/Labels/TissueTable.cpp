#include "Labels/TissueTable.h"

#include "Core/Progress.h"
#include "Labels/CsvFile.h"

#include <cmath>
#include <limits>
#include <sstream>

namespace sono {

namespace {

/// One number of a tissue: its column, where it is kept, and its range.
struct Property
{
  const char* column;
  double Tissue::*member;
  double minimum;
  double maximum;
  const char* meaning;
  bool optional = false; ///< a table without its column gives every tissue the default
};

constexpr double unlimited = std::numeric_limits<double>::max();

const Property properties[] = {
  { "impedance_MRayl", &Tissue::impedanceMRayl, 1e-4, 1e4,
    "Acoustic impedance in MRayl, 0.0001 to 10000: its step at a boundary is what echoes." },
  { "sound_speed_m_per_s", &Tissue::soundSpeedMPerS, 10.0, 1e5,
    "Speed of sound in m/s, 10 to 100000: bends paths, and shifts what lies behind." },
  { "attenuation_dB_per_cm_MHz", &Tissue::attenuationDbPerCmMHz, 0.0, unlimited,
    "Attenuation of the amplitude in dB/cm/MHz, one way, at least 0." },
  { "mu0", &Tissue::scattererMean, 0.0, 1.0,
    "Mean amplitude of the scatterers, no unit, 0 to 1: how bright the speckle is in the model Amadou 2024; not used "
    "by Acoustic." },
  { "sigma0", &Tissue::scattererSigma, 0.0, 1.0,
    "Standard deviation of the scatterers' amplitudes, no unit, 0 to 1: how uneven the speckle is in the model Amadou "
    "2024; not used by Acoustic." },
  { "mu1", &Tissue::scattererProbability, 0.0, 1.0,
    "Share of the candidate places that hold a scatterer, no unit, 0 to 1." },
  { "tau", &Tissue::tau, 0.0, 3.0,
    "Exponent of the intensity in a boundary's echo, no unit, 0 to 3, in the model Amadou 2024; 1 is neutral." },
  { "gamma", &Tissue::gamma, -2.0, 2.0,
    "Exponent of the cosine of the angle in a boundary's echo, no unit, -2 to 2, in the model Amadou 2024; 0 is "
    "neutral." },
  { "roughness_mm", &Tissue::roughnessMm, 0.0, 10.0,
    "Root mean square height of its surface in mm, 0 to 10; 0 is a mirror.", true },
  { "correlation_mm", &Tissue::correlationMm, 0.01, 100.0,
    "Correlation length of that height in mm, 0.01 to 100: the longer, the less it scatters aside.", true },
  { "backscatter_1MHz_per_cm_sr", &Tissue::backscatterPerCmSr, 0.0, 1.0,
    "Backscatter coefficient at 1 MHz in 1/(cm sr), 0 to 1: how bright the tissue is in the model Acoustic.", true },
  { "backscatter_exponent", &Tissue::backscatterExponent, 0.0, 6.0,
    "How backscatter grows with the frequency, no unit, 0 to 6; 4 is Rayleigh scattering.", true },
  { "fibre_anisotropy_dB", &Tissue::fibreAnisotropyDb, 0.0, 60.0,
    "How much brighter it is across its fibres than along them, in dB, 0 to 60.", true },
  { "nonlinearity", &Tissue::nonlinearity, 0.0, 20.0,
    "beta = 1 + B/(2A), no unit, 0 to 20: what the second harmonic grows by.", true },
};

std::string rangeOf(const Property& property)
{
  std::ostringstream text;
  if (property.maximum == unlimited)
  {
    text << "a finite number of at least " << property.minimum;
  }
  else
  {
    text << "a number from " << property.minimum << " to " << property.maximum;
  }
  return text.str();
}

bool isInRange(const Property& property, double value)
{
  return std::isfinite(value) && value >= property.minimum && value <= property.maximum;
}

double readNumber(const CsvFile& csv, const CsvFile::Row& row, const Property& property, const std::string& tissue)
{
  const std::string& text = row.fields[std::size_t(csv.requiredColumn(property.column))];
  const auto value = parseNumber(text);
  if (!value)
  {
    throw Error(csv.where(row) + ": tissue '" + tissue + "' has '" + text + "' in column '" + property.column +
                "'; write " + rangeOf(property) + ".");
  }
  return *value;
}

} // namespace

const std::vector<TissueColumn>& tissueColumns()
{
  static const std::vector<TissueColumn> columns = [] {
    std::vector<TissueColumn> all;
    for (const Property& property : properties)
    {
      all.push_back({ property.column, property.member, property.meaning });
    }
    return all;
  }();
  return columns;
}

void checkRanges(const Tissue& tissue)
{
  for (const Property& property : properties)
  {
    const double value = tissue.*property.member;
    if (!isInRange(property, value))
    {
      std::ostringstream message;
      message << "tissue '" << tissue.name << "' has " << value << " in column '" << property.column << "'; write "
              << rangeOf(property) << ".";
      throw Error(message.str());
    }
  }
}

TissueTable TissueTable::read(const std::string& path)
{
  return of(CsvFile::read(path));
}

TissueTable TissueTable::parse(const std::string& text, const std::string& name)
{
  return of(CsvFile::parse(text, name));
}

TissueTable TissueTable::of(const CsvFile& csv)
{
  const auto name = std::size_t(csv.requiredColumn("tissue"));
  const auto source = std::size_t(csv.requiredColumn("source"));
  TissueTable table;
  for (const CsvFile::Row& row : csv.rows)
  {
    Tissue tissue;
    tissue.name = row.fields[name];
    tissue.source = row.fields[source];
    for (const Property& property : properties)
    {
      if (property.optional && csv.column(property.column) < 0)
      {
        continue;
      }
      tissue.*property.member = readNumber(csv, row, property, tissue.name);
    }
    try
    {
      table.add(tissue);
    }
    catch (const Error& error)
    {
      throw Error(csv.where(row) + ": " + error.what());
    }
  }
  if (table.tissues_.empty())
  {
    throw Error("'" + csv.path + "' holds no tissue; add a line for each.");
  }
  return table;
}

void TissueTable::add(const Tissue& tissue)
{
  if (tissue.name.empty())
  {
    throw Error("a tissue has no name; give it one in column 'tissue'.");
  }
  if (find(tissue.name))
  {
    throw Error("tissue '" + tissue.name + "' is there twice; rename or remove one.");
  }
  checkRanges(tissue);
  tissues_.push_back(tissue);
}

const Tissue* TissueTable::find(const std::string& name) const
{
  for (const Tissue& tissue : tissues_)
  {
    if (tissue.name == name)
    {
      return &tissue;
    }
  }
  return nullptr;
}

double decayPerMm(const Tissue& tissue, double frequencyMHz)
{
  return tissue.attenuationDbPerCmMHz * frequencyMHz * std::log(10.0) / 100.0;
}

double backscatterPerMmSr(const Tissue& tissue, double frequencyMHz)
{
  return 0.1 * tissue.backscatterPerCmSr * std::pow(frequencyMHz, tissue.backscatterExponent);
}

} // namespace sono
