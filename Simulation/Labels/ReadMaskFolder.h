#pragma once

#include "Core/Progress.h"
#include "Labels/LabelVolume.h"

#include <string>

namespace sono {

/// Reads a folder of masks, one file a structure, as TotalSegmentator writes them (segmentations/liver.nii.gz): NIfTI,
/// NRRD or MetaImage, in each 0 and one other number. A structure is named as its file without the ending. The files,
/// in the order of their names' bytes, are the labels 1, 2, 3, ...; one whose mask is empty keeps its number, so that a
/// number stands for the same structure in all folders with the same names. Where masks overlap the one with fewer
/// voxels wins (VoxelRuns.h), and `notice` says so. Files below the folder and of other kinds are not looked at. Throws
/// Error for a folder without masks, masks of unequal size or place, and a file with more than one number besides 0;
/// and Aborted.
LabelVolume readMaskFolder(const std::string& folder, const Progress& progress = {});

/// Where the masks stand, from the header of the first.
GridPlacement maskFolderPlacement(const std::string& folder);

/// The folder that a path means: itself, or that of one of its files.
std::string maskFolderOf(const std::string& path);

/// Whether a path is a folder with files of a label map's formats, or a mask with another such file beside it.
bool mayBeMasks(const std::string& path);

} // namespace sono
