#pragma once

#include "vtkSonoProbeRepresentation.h"

#include "vtkActor.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkSonoProbeSource.h"
#include "vtkSonoSkin.h"
#include "vtkSphereSource.h"
#include "vtkTextActor.h"
#include "vtkVector.h"

#include <array>
#include <string>

struct SonoColour
{
  double r, g, b;
};

/// Of the handle that leads to a state; of the transducer for the others.
SonoColour sonoColourOf(int state);

/// A part of the picture.
struct SonoProbePart
{
  SonoProbePart() { this->Actor->SetMapper(this->Mapper); }
  void SetColour(const SonoColour& c) { this->Actor->GetProperty()->SetColor(c.r, c.g, c.b); }
  vtkNew<vtkPolyDataMapper> Mapper;
  vtkNew<vtkActor> Actor;
};

/// What is drawn of the probe, and what is known of the movement that is under way.
class vtkSonoProbeRepresentation::Internals
{
public:
  Internals();

  /// Draws the transducer, the fan and the frame anew where their numbers have changed.
  void UpdateShape();
  /// Where a state's handle is in the probe's frame (lateral, elevational, axial).
  vtkVector3d HandlePlace(int state);
  /// A point of the ring, and its radius.
  vtkVector3d RingPoint(int step) const;
  double RingMm() const { return this->HalfWidthMm + 14.0; }
  static constexpr int RingSteps = 72;

  SonoProbePart& Handle(int state) { return this->Handles[static_cast<std::size_t>(state - ROTATING)]; }

  template<typename Work>
  void ForEachActor(const Work& work)
  {
    for (SonoProbePart* part : { &this->Outline, &this->Frame, &this->Head, &this->Marker })
    {
      work(part->Actor.Get());
    }
    for (SonoProbePart& part : this->Handles)
    {
      work(part.Actor.Get());
    }
  }

  vtkNew<vtkSonoProbeSource> Probe; // in its own frame: (lateral, elevational, axial)
  std::string PresetFile;
  vtkMTimeType ShapeTime = 0;
  double DrawnDepthMm = 0.0; // of the preset, where there is one
  double HalfWidthMm = 10.0;
  double CatheterMm = 0.0;

  vtkNew<vtkSonoSkin> Skin;
  vtkNew<vtkPolyData> OutlineShape;
  vtkNew<vtkMatrix4x4> Placement;
  vtkNew<vtkSphereSource> Ball;
  vtkNew<vtkSphereSource> MarkerBall;
  SonoProbePart Outline;
  SonoProbePart Frame;
  SonoProbePart Head;
  SonoProbePart Marker;
  std::array<SonoProbePart, 4> Handles;
  vtkNew<vtkTextActor> Text;
  double Bounds[6];

  // Of the movement that is under way.
  vtkVector3d Grip{ 0.0 }; // the grabbed point in the probe's frame
  vtkVector2d Offset{ 0.0 };
  double Moved = 0.0;
  bool Stands = false; // on the skin, with this normal
  vtkVector3d Outward{ 0.0 };
  int Hovered = OUTSIDE;
};
