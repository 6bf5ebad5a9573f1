#pragma once

class vtkSMSourceProxy;

/// Places the probe of a new Simulate Ultrasound where an Acoustic Window finds its input's, unless its pose was set
/// already. On the client; the search runs where the data are.
void sonoSetFirstPose(vtkSMSourceProxy* ultrasound);
