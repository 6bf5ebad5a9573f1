#pragma once

class vtkSMProxy;
class vtkSMSourceProxy;

/// What a click or a camera has to know of an output.
enum class SonoImageKind
{
  None,
  InWorld,
  Flat
};
SonoImageKind sonoImageKind(vtkSMProxy* source, unsigned int port);

/// The output that a flat view shows; a null source where a view is none.
struct SonoShownImage
{
  vtkSMSourceProxy* source = nullptr;
  unsigned int port = 0;
};
SonoShownImage sonoFlatImageOf(vtkSMProxy* view);

/// Whether a view shows a flat image, and that as pictures are looked at, without turning it.
bool sonoIsFlatView(vtkSMProxy* view);
