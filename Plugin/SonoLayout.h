#pragma once

#include <functional>

class vtkSMSourceProxy;
class vtkSMViewProxy;

/// Sets up a tab "Ultrasound" for a Simulate Ultrasound, unless there is one that shows it: the anatomy, translucent,
/// with probe, fan and image in place; the image flat with a depth scale in cm and the probe's marker; the RF and
/// envelope of one line, which is drawn into both images. Makes an A-Line and a Flat Image Scale for that, unless there
/// are some. The flat view is filled first and given to drawNow, which is to bring it to the screen: the rest can take
/// long. The view with the anatomy.
vtkSMViewProxy* sonoShowLayout(vtkSMSourceProxy* ultrasound, const std::function<void(vtkSMViewProxy*)>& drawNow);
