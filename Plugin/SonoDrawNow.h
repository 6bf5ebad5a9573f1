#pragma once

class vtkSMViewProxy;

/// Brings a view onto the screen, without waiting for the end of what a click does: its place in the window, its
/// picture, and that into the window. A person's clicks and keys wait, and timers, some of which draw other views.
void sonoDrawNow(vtkSMViewProxy* view);

/// The same of what the window shows already: before what takes ParaView a second or two, such as panels of a source.
void sonoShowSoFar();
