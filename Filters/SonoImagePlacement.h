#pragma once

#include "Image/ScanConvert.h"
#include "Image/ScanConvertVolume.h"
#include "SonoProbeField.h"

#include <array>

class vtkImageData;
class vtkInformation;

namespace sono {

/// What is drawn on a flat image lies so much in front of it, which is towards negative z.
constexpr double flatDrawingMm = -0.1;

/// A place in the world as the flat image has it, in mm: x lateral, y depth, z out of the image plane, elevation.
Vec3d flatFromWorld(const Vec3d& worldMm, const ProbePose& pose);

/// Where a scan-converted image lies: in mm: in the world, LPS, or flat in the probe's own frame.
class ImagePlacement
{
public:
  /// In the world: x lateral, y axial, z = axial x lateral; a volume x lateral, y elevation, z axial.
  ImagePlacement(const PlaneImage& plane, const ProbePose& pose);
  ImagePlacement(const VolumeImage& volume, const ProbePose& pose);

  /// The same in the frame of the pose: x lateral, y depth. Of a volume it is the plane in the middle, whose elevation
  /// is 0 or half a voxel.
  ImagePlacement flat(const ProbePose& pose) const;

  /// Size, place and scalar type (VTK_FLOAT, ...) of the image, before it is made.
  void announce(int scalarType, vtkInformation* outInfo) const;
  void place(vtkImageData* image) const;

private:
  void setColumns(const Vec3d& x, const Vec3d& y, const Vec3d& z);

  Vec3i size_;
  double pixelMm_;
  Vec3d originMm_;
  std::array<double, 9> direction_{}; // row-major
};

/// The edge of a pixel that is made of the one that is set: wider while the probe is being moved, and where a matrix
/// would have too many voxels.
double pixelMmOf(const ProbeField& probe, double settingMm);

/// Gives a placed flat image the values of the one in the world: all, or of a volume those of the plane in the middle.
void fillFlat(vtkImageData* world, vtkImageData* flat);

/// Of the image of a probe with pixels or voxels of this edge in mm. Throws Error as planeImageLayout().
ImagePlacement placementOf(const ProbeField& probe, double pixelMm);

} // namespace sono
