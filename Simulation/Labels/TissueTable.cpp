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
  bool optional = false; ///< a table without its column gives every tissue the default
};

constexpr double unlimited = std::numeric_limits<double>::max();

const Property properties[] = {
  { "impedance_MRayl", &Tissue::impedanceMRayl, 1e-4, 1e4 },
  { "sound_speed_m_per_s", &Tissue::soundSpeedMPerS, 10.0, 1e5 },
  { "attenuation_dB_per_cm_MHz", &Tissue::attenuationDbPerCmMHz, 0.0, unlimited },
  { "mu0", &Tissue::scattererMean, 0.0, 1.0 },
  { "sigma0", &Tissue::scattererSigma, 0.0, 1.0 },
  { "mu1", &Tissue::scattererProbability, 0.0, 1.0 },
  { "tau", &Tissue::tau, 0.0, 3.0 },
  { "gamma", &Tissue::gamma, -2.0, 2.0 },
  { "roughness_mm", &Tissue::roughnessMm, 0.0, 10.0, true },
  { "correlation_mm", &Tissue::correlationMm, 0.01, 100.0, true },
  { "backscatter_1MHz_per_cm_sr", &Tissue::backscatterPerCmSr, 0.0, 1.0, true },
  { "backscatter_exponent", &Tissue::backscatterExponent, 0.0, 6.0, true },
  { "fibre_anisotropy_dB", &Tissue::fibreAnisotropyDb, 0.0, 60.0, true },
  { "nonlinearity", &Tissue::nonlinearity, 0.0, 20.0, true },
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
      all.push_back({ property.column, property.member });
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
  const CsvFile csv = CsvFile::read(path);
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
    throw Error("'" + path + "' holds no tissue; add a line for each.");
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
