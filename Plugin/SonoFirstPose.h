#pragma once

class vtkSMSourceProxy;

/// Places the probe of a new Simulate Ultrasound where an Acoustic Window finds its input's, with the probe for what it
/// sees, unless its pose was set already. When Fill Body is changed, it is placed anew, unless it has been moved. On
/// the client; the search runs where the data are.
void sonoSetFirstPose(vtkSMSourceProxy* ultrasound);
