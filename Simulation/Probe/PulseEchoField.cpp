#include "Probe/PulseEchoField.h"

#include "Core/Progress.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace sono {

namespace {

constexpr double maxValues = 67108864.0; // 2^26

[[noreturn]] void refuse(const std::string& what, const char* axis, const std::string& problem)
{
  throw Error(what + ": the " + axis + " axis " + problem + ".");
}

void validateAxis(const FieldAxis& axis, const char* name, bool isDepth, const std::string& what)
{
  if (axis.count < 1)
  {
    refuse(what, name, "holds no position; give at least one");
  }
  if (!std::isfinite(axis.minMm) || !std::isfinite(axis.stepMm) || std::abs(axis.minMm) > 1e6 || axis.stepMm > 1e6)
  {
    refuse(what, name, "has a start or step that is not finite or beyond 10^6 mm; give both in mm");
  }
  if (!(axis.stepMm > 0.0))
  {
    std::ostringstream problem;
    problem << "does not ascend (its step is " << axis.stepMm << " mm); order the positions upwards, evenly spaced";
    refuse(what, name, problem.str());
  }
  if (isDepth && axis.minMm < 0.0)
  {
    refuse(what, name, "starts behind the transducer; start it at 0 or deeper");
  }
  if (!isDepth && (axis.minMm > 0.0 || axis.maxMm() < 0.0))
  {
    refuse(what, name, "leaves out the beam's axis; start it at 0 (symmetric half) or let it span 0");
  }
}

double reachMm(const FieldAxis& axis)
{
  return axis.count == 1 ? std::abs(axis.minMm) + 0.5 * axis.stepMm : std::max(-axis.minMm, axis.maxMm());
}

BeamFieldAxis viewAxis(const FieldAxis& axis, int stride, bool mayMirror)
{
  BeamFieldAxis view{};
  const double slackMm = axis.count == 1 ? 0.5 * axis.stepMm : 0.0;
  view.lowMm = float(axis.minMm - slackMm);
  view.highMm = float(axis.maxMm() + slackMm);
  view.minMm = float(axis.minMm);
  view.perMm = axis.count == 1 ? 0.0f : float(1.0 / axis.stepMm);
  view.lastCell = std::max(0, axis.count - 2);
  view.stride = axis.count == 1 ? 0 : stride;
  view.mirrored = mayMirror && axis.minMm == 0.0;
  return view;
}

} // namespace

bool FieldAxis::operator==(const FieldAxis& other) const
{
  return minMm == other.minMm && stepMm == other.stepMm && count == other.count;
}

bool FieldGrid::operator==(const FieldGrid& other) const
{
  return lateral == other.lateral && elevational == other.elevational && depth == other.depth;
}

void FieldGrid::validate(const std::string& what) const
{
  validateAxis(lateral, "lateral", false, what);
  validateAxis(elevational, "elevational", false, what);
  validateAxis(depth, "depth", true, what);
  if (double(lateral.count) * elevational.count * depth.count > maxValues)
  {
    throw Error(what + ": the table would hold more than 2^26 values; use longer steps.");
  }
}

PulseEchoField::PulseEchoField(const FieldGrid& grid, std::vector<float> values, const std::string& what)
  : grid_(grid)
  , values_(std::move(values))
{
  grid_.validate(what);
  if (values_.size() != grid_.size())
  {
    throw Error(what + " has " + std::to_string(values_.size()) + " values but its axes ask for " +
                std::to_string(grid_.size()) + "; make them agree.");
  }
  float largest = 0.0f;
  for (std::size_t n = 0; n < values_.size(); ++n)
  {
    if (!std::isfinite(values_[n]) || values_[n] < 0.0f)
    {
      std::ostringstream message;
      const std::size_t rows = n / std::size_t(grid_.lateral.count);
      message << what << " holds " << values_[n] << " at lateral "
              << grid_.lateral.at(int(n % std::size_t(grid_.lateral.count))) << ", elevational "
              << grid_.elevational.at(int(rows % std::size_t(grid_.elevational.count))) << ", depth "
              << grid_.depth.at(int(rows / std::size_t(grid_.elevational.count)))
              << " mm; a weight is a finite amplitude of at least 0.";
      throw Error(message.str());
    }
    largest = std::max(largest, values_[n]);
  }
  if (!(largest > 0.0f))
  {
    throw Error(what + " is zero everywhere; check its units and its grid.");
  }
  std::transform(values_.begin(), values_.end(), values_.begin(), [&](float v) { return v / largest; });
}

BeamFieldView PulseEchoField::view(const float* values) const
{
  const int row = grid_.lateral.count;
  return { values, viewAxis(grid_.lateral, 1, true), viewAxis(grid_.elevational, row, true),
           viewAxis(grid_.depth, row * grid_.elevational.count, false) };
}

double PulseEchoField::lateralReachMm() const
{
  return reachMm(grid_.lateral);
}

double PulseEchoField::elevationalReachMm() const
{
  return reachMm(grid_.elevational);
}

} // namespace sono
