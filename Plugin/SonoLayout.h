#pragma once

class vtkSMSourceProxy;

/// Sets up a new tab "Ultrasound" for a Simulate Ultrasound: the anatomy, translucent, with probe, fan and image in
/// place; the image flat with a depth scale in cm and the probe's marker; the RF and envelope of one line. Makes an
/// A-Line of its RF lines for the latter, unless there is one.
void sonoShowLayout(vtkSMSourceProxy* ultrasound);
