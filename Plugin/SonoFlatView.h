#pragma once

class vtkSMProxy;

/// What a click or a camera has to know of an output.
enum class SonoImageKind
{
  None,
  InWorld,
  Flat
};
SonoImageKind sonoImageKind(vtkSMProxy* source, unsigned int port);

/// Whether a view shows a flat image, and that as pictures are looked at, without turning it.
bool sonoIsFlatView(vtkSMProxy* view);
