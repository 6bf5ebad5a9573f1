#pragma once

#include "vtkSmartPointer.h"

class vtkPolyData;

/// Sizes of the drawn transducer in mm. It reaches from the face at axial = 0 back to axial = -tailMm.
struct SonoProbeHead
{
  static constexpr double thicknessMm = 15.0; ///< across the image plane
  static constexpr double tailMm = 70.0;      ///< length, cable end included

  /// From the outline that vtkSonoProbeSource gives, moved into the frame of the pose.
  explicit SonoProbeHead(vtkPolyData* outline);

  double halfWidthMm = 10.0; ///< of the face along the array, at least 10
  double radialMm = 0.0;     ///< radius of a catheter that looks all around; 0: a hand-held probe
  vtkSmartPointer<vtkPolyData> surface;

private:
  void makeHandHeld(vtkPolyData* outline);
  void makeCatheter();
};
