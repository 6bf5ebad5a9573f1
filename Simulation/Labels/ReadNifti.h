#pragma once

#include "Core/Progress.h"
#include "Labels/LabelVolume.h"
#include "Labels/VoxelFile.h"

#include <string>

namespace sono {

/// Reads a NIfTI-1 or NIfTI-2 label map (.nii, .nii.gz) with the names and colours of a label table in its header
/// extensions; `labels` holds those, also of ids that no voxel carries. Of a four-dimensional file it reads one phase.
/// Throws Error as readLabelMap does, and Aborted.
LabelVolume readNifti(const std::string& path, int phase = 0, const Progress& progress = {});

/// The numbers of one phase as they stand in the file.
VoxelFile openNifti(const std::string& path, int phase = 0);

/// The phases that a file holds along its fourth axis, 1 for a file with three. Throws Error as readLabelMap does.
LabelPhases readNiftiPhases(const std::string& path);

/// Writes NIfTI-1, uint16; gzip-compressed when the name ends in .gz. Throws Error when that fails.
void writeNifti(const std::string& path, const LabelVolume& volume);

/// The `<Label Key=".." Red=".." Green=".." Blue="..">name</Label>` elements of an XML text (Connectome Workbench's
/// label table; colours 0..1). None of a text that is no XML.
std::vector<LabelInfo> labelsFromXml(const std::string& xml);

} // namespace sono
