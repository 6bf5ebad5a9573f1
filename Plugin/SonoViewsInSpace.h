#pragma once

#include <vector>

class pqRenderView;
class vtkSMSourceProxy;

/// Of the views on the screen, those that show the anatomy or the image of a Simulate Ultrasound in space.
std::vector<pqRenderView*> sonoViewsInSpace(vtkSMSourceProxy* ultrasound);
