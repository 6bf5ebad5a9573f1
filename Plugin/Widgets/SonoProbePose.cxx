#include "SonoProbePose.h"

#include "vtkMath.h"
#include "vtkVectorOperators.h"

#include <cmath>

namespace {

/// Rodrigues' formula; `axis` is a unit vector.
vtkVector3d turned(const vtkVector3d& v, const vtkVector3d& axis, double radians)
{
  const double c = std::cos(radians);
  return v * c + axis.Cross(v) * std::sin(radians) + axis * (axis.Dot(v) * (1.0 - c));
}

vtkVector3d perpendicularTo(const vtkVector3d& unit)
{
  vtkVector3d any;
  vtkMath::Perpendiculars(unit.GetData(), any.GetData(), nullptr, 0.0);
  return any;
}

/// `v` without its part along `unit`, as a unit vector; some other one where nothing is left.
vtkVector3d across(const vtkVector3d& v, const vtkVector3d& unit)
{
  const vtkVector3d rest = v - unit * unit.Dot(v);
  return rest.Norm() > 1e-9 * v.Norm() ? rest.Normalized() : perpendicularTo(unit);
}

} // namespace

SonoProbePose SonoProbePose::from(const double positionMm[3], const double axial[3], const double lateral[3])
{
  SonoProbePose pose;
  pose.positionMm = vtkVector3d(positionMm);
  const vtkVector3d typed(axial);
  if (typed.Norm() > 0.0)
  {
    pose.axial = typed.Normalized();
  }
  pose.lateral = across(vtkVector3d(lateral), pose.axial);
  return pose;
}

vtkVector3d SonoProbePose::world(double lateralMm, double elevationMm, double axialMm) const
{
  return positionMm + lateral * lateralMm + elevation() * elevationMm + axial * axialMm;
}

void SonoProbePose::turn(const vtkVector3d& axis, double radians)
{
  axial = turned(axial, axis, radians).Normalized();
  lateral = across(turned(lateral, axis, radians), axial);
}

void SonoProbePose::rotate(double degrees)
{
  turn(axial, vtkMath::RadiansFromDegrees(degrees));
}

void SonoProbePose::tilt(double degrees)
{
  turn(lateral, -vtkMath::RadiansFromDegrees(degrees)); // lateral x axial points against the elevation
}

void SonoProbePose::rock(double degrees)
{
  turn(elevation(), vtkMath::RadiansFromDegrees(degrees));
}

void SonoProbePose::carry(const vtkVector3d& from, const vtkVector3d& to)
{
  const vtkVector3d axis = from.Cross(to);
  const double sine = axis.Norm();
  const double angle = std::atan2(sine, from.Dot(to));
  if (angle > 0.0)
  {
    // Opposite vectors leave the axis open; the lateral direction then stays, as far as it can.
    turn(sine > 1e-12 ? axis * (1.0 / sine) : across(lateral, from), angle);
  }
}
