#pragma once

#include "Kernel/Vec.h"
#include "Labels/LabelVolume.h"

#include <dcmtk/config/osconfig.h>

#include <dcmtk/dcmdata/dctk.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sono {

/// Opens a DICOM file, with its texts in UTF-8; `withPixels` false stops before them. Throws Error naming the file.
std::unique_ptr<DcmFileFormat> openDicom(const std::string& path, bool withPixels);

/// Decompresses the pixels, where DCMTK can (RLE, JPEG, JPEG-LS). Throws Error naming the file.
void decompressPixels(DcmDataset& data, const std::string& path);

/// The first value of an element as text; empty where it is absent.
std::string dicomText(DcmItem& item, const DcmTagKey& tag);
/// Value `index` of an element as a number; none where it is absent or no number.
std::optional<double> dicomNumber(DcmItem& item, const DcmTagKey& tag, unsigned long index = 0);
/// All values as numbers; empty where they are not `count` finite ones.
std::vector<double> dicomNumbers(DcmItem& item, const DcmTagKey& tag, std::size_t count);
/// Item `index` of a sequence; nullptr where it is absent.
DcmItem* dicomItem(DcmItem& item, const DcmTagKey& sequence, unsigned long index = 0);

/// Planes of pixels that lie on one another, one place each.
struct DicomPlanes
{
  std::string path; ///< for messages
  int columns = 0;
  int rows = 0;
  std::vector<double> orientation;      ///< six numbers of Image Orientation (Patient)
  std::vector<double> spacing;          ///< two of Pixel Spacing: between rows, between columns
  std::vector<Vec3d> positions;         ///< Image Position (Patient) of each plane
  std::optional<double> sliceSpacingMm; ///< as the file says it
};

/// Where planes stand in a volume. DICOM's coordinates are LPS mm, as ours are.
struct DicomStack
{
  GridPlacement placement;
  std::vector<int> slices; ///< k of each plane
};

/// Puts planes in order along their normal. `gaps`: places between them may be empty (a segmentation leaves out slices
/// without segments). Throws Error for planes that are not on one stack at equal distances.
DicomStack stackPlanes(const DicomPlanes& planes, bool gaps);

} // namespace sono
