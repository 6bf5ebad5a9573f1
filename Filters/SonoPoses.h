#pragma once

#include "Probe/ScanGeometry.h"

#include "vtkSmartPointer.h"

#include <vector>

class vtkDataObject;
class vtkDoubleArray;
class vtkFieldData;
class vtkTable;

namespace sono {

/// The poses of points with the point arrays "Axial" and "Lateral", or of a table's rows; orthonormal. Throws Error
/// naming what is missing, and the pose that is none.
std::vector<ProbePose> posesOf(vtkDataObject* data);

/// A row a pose, with the columns that posesOf reads.
void fillPoses(const std::vector<ProbePose>& poses, vtkTable* table);

/// One of the poses' vectors, a tuple a pose.
vtkSmartPointer<vtkDoubleArray> poseVectors(const char* name, const std::vector<ProbePose>& poses,
                                            Vec3d ProbePose::*vector);

/// The poses of a sweep's images, in their field data: "PosePositionMm", "PoseAxial" and "PoseLateral", a tuple an
/// image.
void writePoses(const std::vector<ProbePose>& poses, vtkFieldData* field);
/// Empty where there are none.
std::vector<ProbePose> readPoses(vtkFieldData* field);
/// Those of `count` pictures: of a sweep its own, else all that of the probe.
std::vector<ProbePose> picturePoses(vtkFieldData* field, const ProbePose& probe, std::size_t count);

} // namespace sono
