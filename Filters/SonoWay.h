#pragma once

#include "Probe/ScanGeometry.h"

#include "vtkSmartPointer.h"

#include <memory>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataObject;
class vtkFieldData;
class vtkPolyData;
class vtkStringArray;

namespace sono {

class Scene;

/// What filters that look for a probe's place have in common: they take a label image or a scene, and put out the way
/// of the sound from the place that was chosen.

/// The scene of the input, or of the label image that it is, which is built within the first half of the owner's
/// progress.
std::shared_ptr<const Scene> sceneToSearch(vtkDataObject* input, int fillBody, vtkAlgorithm* owner);

/// A line from the transducer's face, with the pose in the field data: ProbePositionMm, ProbeAxial, ProbeLateral.
void writeWay(const ProbePose& pose, double depthMm, vtkPolyData* way);
/// The line alone.
void drawWay(const Vec3d& begin, const Vec3d& end, vtkPolyData* way);

/// A place as text for a panel: sentence, preset, depth in mm, and three numbers each of position, axial and lateral,
/// separated by tabs.
std::string rowOf(const ProbePose& pose, double depthMm, const std::string& preset, const std::string& sentence);

vtkSmartPointer<vtkStringArray> namedStrings(const char* name, const std::vector<std::string>& values);

} // namespace sono
