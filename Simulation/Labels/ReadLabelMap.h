#pragma once

#include "Core/Progress.h"
#include "Labels/LabelVolume.h"

#include <string>

namespace sono {

/// Reads a label map and places it in the world (LPS mm): NIfTI-1/2 (.nii, .nii.gz; sform before qform, RAS flipped to
/// LPS; with neither, only the spacing counts and i, j, k are taken as L, P, S), NRRD (.nrrd, .nhdr, .seg.nrrd with
/// segment names and colours; LPS, RAS or LAS space) and MetaImage (.mha, .mhd). Overlapping segment layers are
/// flattened: where segments overlap the one with fewer voxels wins, and `notice` says so.
/// A DICOM Segmentation (any name; ReadDicomSeg.h) and a folder of masks (ReadMaskFolder.h) are read, too.
/// Names and colours come from the file where it has them, then from a table beside it (LabelTable.h). Numbers alone
/// name nothing but a heart of MM-WHS (KnownNumbers.h): TotalSegmentator's versions give the same number to different
/// organs. Whole numbers stored as floats are accepted. Throws Error for a missing or unreadable file, a zero-sized
/// image, voxels that are not whole numbers in 0..65535, or more than three dimensions. Only NIfTI may have a fourth
/// one, time: `phase`, from 0, chooses from it. Throws Aborted, too.
LabelVolume readLabelMap(const std::string& path, int phase = 0, const Progress& progress = {});

/// Where a label map stands, from its header alone. Throws Error as readLabelMap does.
GridPlacement readLabelPlacement(const std::string& path);

/// The phases of a label map's file, without its voxels. Throws Error as above.
LabelPhases readLabelPhases(const std::string& path);

/// Sets names, and colours and tissues where the table has them, of the labels that occur. Throws Error as readLabels
/// does.
void readLabelTable(const std::string& tablePath, LabelVolume& volume);
/// The same from rows that were read.
void describeLabels(const std::vector<LabelInfo>& rows, LabelVolume& volume);

/// Writes NIfTI-1 (.nii or .nii.gz, uint16, sform and qform) with label names and colours beside it in `<stem>.csv`.
/// Throws Error when a file cannot be written or an axis has more than 32767 voxels.
void writeLabelMap(const std::string& path, const LabelVolume& volume);

} // namespace sono
