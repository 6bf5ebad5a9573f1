#pragma once

class vtkSMSessionProxyManager;
class vtkSMSourceProxy;
class vtkSMViewProxy;

/// Sets up a tab "Ultrasound" for a Simulate Ultrasound, unless there is one that shows it: the anatomy, translucent,
/// with probe, fan and image in place; the image flat with rulers in cm, a grey bar, the probe's marker and text; the
/// RF and envelope of one line, which is drawn into both images. Makes an A-Line, a Flat Image Scale and a Flat Image
/// Text for that, unless there are some. The flat view comes to the screen first, then the body: all of it can
/// take long. The view with the anatomy.
vtkSMViewProxy* sonoShowLayout(vtkSMSourceProxy* ultrasound);

/// A tab of this name with the flat views of two Simulate Ultrasounds side by side, and below them the first one's
/// body, each on the screen as soon as it is filled. Returns the body's view.
vtkSMViewProxy* sonoShowSplitLayout(const char* tab, vtkSMSourceProxy* first, vtkSMSourceProxy* second);
/// One more image in a body's view.
void sonoShowImageInBody(vtkSMSourceProxy* ultrasound, vtkSMViewProxy* body);

/// Has the views of anatomies draw as the layout's do. A state file loses that: ParaView's settings for all views
/// overwrite it there.
void sonoDrawEasily(vtkSMSessionProxyManager* manager);

/// The A-Line's line over time, of the phases of the label map, in a view below another one of the same layout. Makes
/// an M-Mode, unless there is one; all phases are simulated for it. The view with the anatomy, if there is one.
vtkSMViewProxy* sonoShowMMode(vtkSMSourceProxy* ultrasound, vtkSMViewProxy* beside);
