#pragma once

#include "vtkInteractorObserver.h"
#include "vtkRenderer.h"
#include "vtkVector.h"
#include "vtkVectorOperators.h"

/// Projections of one renderer.
class SonoDisplay
{
public:
  explicit SonoDisplay(vtkRenderer* renderer)
    : Renderer(renderer)
  {
  }
  vtkVector2d of(const vtkVector3d& world) const
  {
    double display[3];
    vtkInteractorObserver::ComputeWorldToDisplay(this->Renderer, world[0], world[1], world[2], display);
    return { display[0], display[1] };
  }
  vtkVector3d worldAt(double x, double y, double z) const
  {
    double world[4];
    vtkInteractorObserver::ComputeDisplayToWorld(this->Renderer, x, y, z, world);
    return vtkVector3d(world);
  }
  double mmPerPixel(const vtkVector3d& world) const
  {
    double display[3];
    vtkInteractorObserver::ComputeWorldToDisplay(this->Renderer, world[0], world[1], world[2], display);
    const vtkVector3d beside = this->worldAt(display[0] + 1.0, display[1], display[2]);
    return (beside - this->worldAt(display[0], display[1], display[2])).Norm();
  }

private:
  vtkRenderer* Renderer;
};
