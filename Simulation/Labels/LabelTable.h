#pragma once

#include "Labels/LabelVolume.h"

#include <string>
#include <vector>

namespace sono {

/// Names and colours of labels from a table:
/// - CSV with a header line and the columns `id,name` and perhaps `r,g,b`, or those of 3D Slicer's colour tables
///   (`LabelValue,Name,Color_R,Color_G,Color_B`, and the label's code in
///   `SegmentedPropertyTypeCodeSequence.CodingSchemeDesignator`, `.CodeValue` and `.CodeMeaning`); colours 0..255; a
///   column `tissue`, where it is filled, says which tissue the label is;
/// - TSV of BIDS (`dseg.tsv`): the columns `index,name` and perhaps `color` (rrggbb behind a hash sign);
/// - ITK-SNAP label description: lines of `id r g b alpha visible mesh "name"`; its "Clear Label" names nothing;
/// - 3D Slicer colour table (.ctbl): lines of `id name r g b a`; a colour without a name is passed over;
/// - plain text: lines of `id name`, perhaps with one number after it (a voxel count).
/// In the last three '#' starts a comment and lines before the first that begins with a number are skipped.
/// Throws Error naming file and line for one that is missing or not of these forms.
std::vector<LabelInfo> readLabels(const std::string& path);
/// The same of the text of a CSV table, whose name stands for the file's in messages.
std::vector<LabelInfo> parseLabels(const std::string& text, const std::string& name);

/// The table that belongs to the label map STEM.nii (or with another ending), the first of:
/// - STEM.csv, .label, .ctbl, .tsv or .txt;
/// - START_labels with these endings, where STEM begins with START_;
/// - a table whose name goes on behind STEM, as STEM-lut.ctbl and STEM_ColorTable.ctbl;
/// - BIDS: a `..._dseg.tsv` in the folder, or above it in the data set, all parts of whose name STEM has;
/// - `labels` with these endings;
/// - the only .ctbl or .label in the folder, unless another file has its name.
/// A file that holds no labels is passed over. Empty when there is none.
std::string labelTableBeside(const std::string& stem);

} // namespace sono
