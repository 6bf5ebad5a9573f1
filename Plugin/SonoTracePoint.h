#pragma once

class vtkSMRenderViewProxy;
class vtkSMSourceProxy;

/// Adds the place of a view's pixel to the contour that a Ventricle Volume has of the flat image there, as one step of
/// undo. False where the source is none, takes its contours from labels, or has not that image.
bool sonoTracePoint(vtkSMSourceProxy* volume, vtkSMRenderViewProxy* view, int x, int y);
