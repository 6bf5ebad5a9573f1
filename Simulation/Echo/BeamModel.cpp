#include "Echo/BeamModel.h"

#include "Echo/FieldLevel.h"
#include "Probe/BeamAperture.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr float reachStepMm = 1.0f;
constexpr int reachSubsteps = 8; // places at which a step is asked; the beam is smooth

BeamKind kindOf(const EchoSettings& settings, InterfaceModel model)
{
  if (settings.field)
  {
    return BeamKind::Field;
  }
  if (settings.arrayField)
  {
    return BeamKind::Array;
  }
  const bool oneWidth = model == InterfaceModel::Amadou2024;
  return settings.aperture.isNamed() && !oneWidth ? BeamKind::Aperture : BeamKind::Gaussian;
}

/// Integrals along one axis of a field's weight and of its square; the sigma of the Gaussian that has both.
double sigmaAlong(const FieldAxis& axis, const std::function<double(double)>& weight)
{
  const bool isHalf = axis.minMm == 0.0 && axis.count > 1;
  constexpr int finer = 4; // than the table, which is linear between its values
  const double lowMm = isHalf ? -axis.maxMm() : axis.minMm - (axis.count == 1 ? 0.5 * axis.stepMm : 0.0);
  const double highMm = axis.maxMm() + (axis.count == 1 ? 0.5 * axis.stepMm : 0.0);
  const int steps = finer * std::max(2, 2 * axis.count);
  const double stepMm = (highMm - lowMm) / steps;
  double first = 0.0;
  double second = 0.0;
  for (int i = 0; i < steps; ++i)
  {
    const double w = weight(lowMm + (i + 0.5) * stepMm);
    first += w * stepMm;
    second += w * w * stepMm;
  }
  return second > 0.0 ? first * first / (2.0 * std::sqrt(pi) * second) : 0.0;
}

} // namespace

BeamModel::BeamModel(const EchoSettings& settings, InterfaceModel model)
  : settings_(settings)
  , kind_(kindOf(settings, model))
{
  if (kind_ == BeamKind::Aperture)
  {
    straight_ = apertureProfile(settings.aperture, settings.centreFrequencyMHz, settings.imagingMode);
    focusMm_ = focusDepthMm(settings.aperture, settings.sentFrequencyMHz());
    tabulateReach();
  }
  if (kind_ == BeamKind::Field)
  {
    field_ = settings.field->view();
    const FieldLevel level(*settings.field);
    focusMm_ = level.focusMm();
    focusPowerAreaMm2_ = level.focusAreaMm2();
  }
  if (kind_ == BeamKind::Array)
  {
    array_ = settings.arrayField->view();
    focusMm_ = settings.arrayField->focusMm();
    sight_ = &settings.arrayField->sight();
    sightView_ = sight_->view();
  }
  const BeamWidth focus = widthAt(focusMm_);
  const double sigmasMm2 = focus.lateralSigmaMm * focus.elevationalSigmaMm;
  focusAreaMm2_ = 2.0 * pi * sigmasMm2 * focus.amplitude;
  if (kind_ != BeamKind::Field)
  {
    focusPowerAreaMm2_ = pi * sigmasMm2 * focus.amplitude * focus.amplitude;
  }
}

BeamWidth BeamModel::widthAt(double depthMm) const
{
  switch (kind_)
  {
    case BeamKind::Aperture:
    {
      const ProfileAt at = profileAt(straight_, float(std::max(depthMm, 0.0)));
      return { 1.0 / std::sqrt(double(at.perLateral2)), 1.0 / std::sqrt(double(at.perElevational2)), at.amplitude };
    }
    case BeamKind::Field:
    {
      const float z = std::clamp(float(depthMm), field_->depth.lowMm, field_->depth.highMm);
      const FieldGrid& grid = settings_.field->grid();
      const auto along = [&](double mm) { return double(beamWeight(*field_, float(mm), 0.0f, z)); };
      const auto across = [&](double mm) { return double(beamWeight(*field_, 0.0f, float(mm), z)); };
      return { sigmaAlong(grid.lateral, along), sigmaAlong(grid.elevational, across),
               beamWeight(*field_, 0.0f, 0.0f, z) };
    }
    case BeamKind::Array:
    {
      const float range = std::max(float(depthMm), 1.0f);
      const auto along = [&](const ArrayBeamAxis& axis, auto weight) {
        const double reachMm = double(float(axis.count - 1) / axis.perUnit * std::max(range, axis.nearMm));
        const auto modulus = [&](double mm) {
          const ComplexWeight w = weight(float(mm));
          return double(std::hypot(w.re, w.im));
        };
        return sigmaAlong({ 0.0, reachMm / (axis.count - 1), axis.count }, modulus);
      };
      const ComplexWeight onAxis = arrayBeamWeight(*array_, 0.0f, 0.0f, range);
      return { along(array_->lateral, [&](float mm) { return arrayBeamWeight(*array_, mm, 0.0f, range); }),
               along(array_->elevational, [&](float mm) { return arrayBeamWeight(*array_, 0.0f, mm, range); }),
               std::hypot(onAxis.re, onAxis.im) };
    }
    default:
      return { settings_.lateralSigmaMm, settings_.elevationalSigmaMm, 1.0 };
  }
}

double BeamModel::cellAreaMm2(double depthMm) const
{
  const BeamWidth width = widthAt(depthMm);
  return pi * width.lateralSigmaMm * width.elevationalSigmaMm;
}

void BeamModel::tabulateReach()
{
  BeamReachTable table(reachStepMm);
  const int steps =
    int(std::ceil(settings_.depthMm * deepestPerRange / double(reachStepMm))) + 8; // half a pulse deeper, and more
  for (int n = 0; n < steps; ++n)
  {
    Vec2f widest(0.0f);
    for (int i = 0; i <= reachSubsteps; ++i)
    {
      const ProfileAt at = profileAt(straight_, (float(n) + float(i) / float(reachSubsteps)) * reachStepMm);
      widest = glm::max(widest, Vec2f(1.0f / std::sqrt(at.perLateral2), 1.0f / std::sqrt(at.perElevational2)));
    }
    table.add(beamCutSigma * widest);
  }
  reach_ = std::move(table);
}

Beam BeamModel::beamOf(const ScanLine& line, const Vec3d& origin, const Mat3d& rotation) const
{
  Beam beam{};
  beam.origin = Vec3f(origin);
  beam.axis = Vec3f(rotation * line.axis);
  beam.lateral = Vec3f(rotation * line.lateral);
  beam.elevation = Vec3f(rotation * line.elevation);
  beam.lateralSigmaMm = float(settings_.lateralSigmaMm);
  beam.elevationalSigmaMm = float(settings_.elevationalSigmaMm);
  beam.kind = kind_;
  if (kind_ == BeamKind::Field)
  {
    beam.field = &*field_;
  }
  if (kind_ == BeamKind::Array)
  {
    const double lateral2 = 1.0 - line.steeringLateral * line.steeringLateral;
    beam.array = &*array_;
    beam.arraySight = &*sightView_;
    beam.lateralCosine = float(std::sqrt(lateral2));
    beam.elevationalCosine = float(std::sqrt(1.0 - line.steeringElevational * line.steeringElevational / lateral2));
    beam.gain = float(directivity(settings_.aperture, settings_.centreFrequencyMHz, line, settings_.imagingMode));
  }
  if (kind_ == BeamKind::Aperture)
  {
    beam.profile =
      steeredProfile(straight_, settings_.aperture, settings_.centreFrequencyMHz, line, settings_.imagingMode);
  }
  return beam;
}

} // namespace sono
