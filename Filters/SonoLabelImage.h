#pragma once

#include "Labels/LabelVolume.h"
#include "Scene/TissueMotion.h"

#include <cstdint>
#include <memory>
#include <set>
#include <vector>

class vtkAlgorithm;
class vtkDataArray;
class vtkFieldData;
class vtkImageData;
class vtkInformation;
class vtkInformationVector;

namespace sono {

/// Announces a label image of this grid: whole extent, origin, spacing, direction, unsigned short scalars.
void announceLabelImage(const GridPlacement& placement, vtkInformation* outInfo);

/// Point array of a label image with the codes of scanDetail, one a voxel.
constexpr const char* scanDetailArray = "ScanDetail";

/// Point array of a label image with a displacement field: three components, mm along the world's LPS axes. What is at
/// x stood at x - u in the reference phase.
constexpr const char* displacementArray = "DisplacementMm";

/// Field array of such an image with the ids of the labels whose speckle moves with it, the same in all phases.
constexpr const char* movingLabelsArray = "MovingLabels";

/// Field array of an image with its GridPlacement::frameOfReference, where it has one.
constexpr const char* frameOfReferenceArray = "FrameOfReference";

/// The placement of an image.
GridPlacement placementOfImage(vtkImageData* image);

/// Sets an image's size and place.
void placeImage(const GridPlacement& placement, vtkImageData* image);

/// The codes of the scan's detail that a label image carries; empty: none.
std::vector<std::uint8_t> scanDetailOf(vtkImageData* image);

/// The motion that a label image carries, with the labels that it names; where it names none, those of `volume`, the
/// image's labels with their tissues, that move by more than 0.05 mm and are no blood. Null where there is no such
/// array. Throws Error where it has no three components or is not finite.
std::shared_ptr<const TissueMotion> motionOf(vtkImageData* image, const LabelVolume& volume);

/// Adds the arrays.
void addMotion(const std::vector<Vec3f>& displacementMm, const std::set<int>& movingLabels, vtkImageData* image);

/// Tells an array of one component its range, which VTK would look for in each value, serially and twice.
void tellRange(double low, double high, vtkDataArray* array);

/// Fills `image` with the scalars "Labels" and the label table in its field data.
void imageFromLabelVolume(const LabelVolume& volume, vtkImageData* image);
/// The same without a copy of the voxels.
void imageFromLabelVolume(LabelVolume&& volume, vtkImageData* image);

/// The labels of an algorithm's first input, an image: its only point array; else the one that the algorithm is set to
/// process, or the scalars where that is not there.
vtkDataArray* labelArrayOf(vtkAlgorithm* algorithm, vtkInformationVector** input);

/// The label volume of an image from any reader, `labels` being its array of voxels: whole numbers 0 to 65535 of any
/// type. Names, colours and codes come from the field data where they are. Throws Error for an image that is empty or
/// holds no labels, naming the array and the value.
LabelVolume labelVolumeFromImage(vtkImageData* image, vtkDataArray* labels);

/// LabelIds, LabelNames, LabelColors (0 to 1) and, where a label has one, LabelCodes and, where assigned, LabelTissues:
/// one row a label.
void writeLabelTable(const std::vector<LabelInfo>& labels, vtkFieldData* field);

/// The rows of such a table; empty where there is none.
std::vector<LabelInfo> labelTableOf(vtkFieldData* field);

/// The label's own colour, or one that differs from its neighbours' in number.
std::array<float, 3> displayColor(const LabelInfo& label);

} // namespace sono
