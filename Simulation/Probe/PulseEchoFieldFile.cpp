#include "Probe/PulseEchoFieldFile.h"

#include "Core/Progress.h"
#include "Labels/NrrdFile.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <locale>
#include <utility>
#include <vector>

namespace sono {

namespace {

constexpr const char* axisNames[] = { "lateral", "elevational", "depth" };

FieldAxis readAxis(const NrrdAxisInfo& axis, const std::string& name, const std::string& path)
{
  const auto refuse = [&](const std::string& problem) {
    throw Error("'" + path + "': the " + name + " axis " + problem + ".");
  };
  const std::string label = axis.label ? axis.label : "";
  const std::string unit = axis.units ? axis.units : "";
  if (label != name)
  {
    refuse("is labelled '" + label + "'; order the axes lateral, elevational, depth and label them so");
  }
  if (unit != "mm")
  {
    refuse("has the unit '" + unit + "'; give its positions in mm and say \"mm\" under units");
  }
  if (!std::isfinite(axis.min))
  {
    refuse("has no finite start; give it under 'axis mins' in mm");
  }
  if (!std::isfinite(axis.spacing))
  {
    refuse("has no finite step; give it under 'spacings' in mm");
  }
  if (axis.center == nrrdCenterCell)
  {
    refuse("is centred on cells; give the position of the first value and say \"node\" under centers");
  }
  if (axis.size > 67108864)
  {
    refuse("has more than 2^26 positions; use longer steps");
  }
  return { axis.min, axis.spacing, int(axis.size) };
}

} // namespace

PulseEchoField readPulseEchoField(const std::string& path)
{
  if (!std::ifstream(path))
  {
    throw Error("cannot read '" + path + "': no such file, or no permission to read it.");
  }
  const NrrdPointer nrrd = loadNrrd(path);
  if (nrrd->dim != 3)
  {
    throw Error("'" + path + "' has " + std::to_string(nrrd->dim) +
                " axes; a pulse-echo field has three: lateral, elevational, depth.");
  }
  if (nrrd->type == nrrdTypeBlock)
  {
    throw Error("'" + path + "' has values that are not numbers; a pulse-echo field holds amplitudes.");
  }
  FieldGrid grid;
  FieldAxis* const axes[] = { &grid.lateral, &grid.elevational, &grid.depth };
  for (unsigned n = 0; n < 3; ++n)
  {
    *axes[n] = readAxis(nrrd->axis[n], axisNames[n], path);
  }
  grid.validate("'" + path + "'");

  // Scaled in double: Field II's amplitudes may lie below the range of float.
  const auto lookup = nrrdDLookup[nrrd->type];
  double largest = 0.0;
  for (std::size_t n = 0; n < grid.size(); ++n)
  {
    const double value = std::abs(lookup(nrrd->data, n));
    largest = std::isfinite(value) ? std::max(largest, value) : largest;
  }
  std::vector<float> values(grid.size());
  for (std::size_t n = 0; n < values.size(); ++n)
  {
    values[n] = float(lookup(nrrd->data, n) / (largest > 0.0 ? largest : 1.0));
  }
  return PulseEchoField(grid, std::move(values), "'" + path + "'");
}

void writePulseEchoField(const PulseEchoField& field, const std::string& path)
{
  const FieldGrid& grid = field.grid();
  std::ofstream stream(path, std::ios::binary);
  stream.imbue(std::locale::classic());
  stream.precision(std::numeric_limits<double>::max_digits10);
  stream << "NRRD0004\n# SonoVDB pulse-echo field\ntype: float\nendian: little\nencoding: raw\ndimension: 3\n"
         << "sizes: " << grid.lateral.count << ' ' << grid.elevational.count << ' ' << grid.depth.count << '\n'
         << "labels: \"lateral\" \"elevational\" \"depth\"\nunits: \"mm\" \"mm\" \"mm\"\n"
         << "axis mins: " << grid.lateral.minMm << ' ' << grid.elevational.minMm << ' ' << grid.depth.minMm << '\n'
         << "spacings: " << grid.lateral.stepMm << ' ' << grid.elevational.stepMm << ' ' << grid.depth.stepMm << "\n\n";
  stream.write(reinterpret_cast<const char*>(field.values().data()),
               std::streamsize(field.values().size() * sizeof(float)));
  if (!stream.flush())
  {
    throw Error("cannot write '" + path + "': no such folder, no permission, or no room.");
  }
}

} // namespace sono
