#pragma once

#include "Files/DicomCine.h"
#include "Files/GreyFrames.h"
#include "Labels/LabelVolume.h"

#include <cstdint>
#include <fstream>
#include <set>
#include <string>
#include <vector>

namespace sono {

/// A DICOM Segmentation (PS3.3 A.51, BINARY) of the label that each pixel of a DicomCine shows: a segment a label that
/// occurs, numbered from 1 in the order of their ids, with its name, colour and code; a frame for each picture and
/// label in it, which names the picture's frame in that file, its place (of the first pixel, LPS mm), time and pixel
/// size. Label 0 is no segment. The pictures are taken one by one and their bits kept in a file without a name beside
/// it, so that their number does not ask for memory, where DCMTK's own segmentations keep all frames. The file appears
/// when all are there, or not at all.
class DicomMasks
{
public:
  /// `poses` are those of the pictures, orthonormal and as many as `cine.timesS`; `labels` says what is known of the
  /// ids. Throws Error naming the path where it cannot be written, and as DicomCine.
  DicomMasks(const std::string& path, const CineInfo& cine, const std::vector<ProbePose>& poses,
             const std::vector<LabelInfo>& labels);

  /// The labels of the next picture. Throws Error for another size, one too many, a full disk, and more than 4 GB.
  void add(const std::uint16_t* labels, int width, int height);
  /// Throws Error where pictures are missing, no pixel shows a label, or the disk is full.
  void finish();

  /// A frame of the file: the picture's number from 0, and the label that it shows.
  struct Frame
  {
    std::size_t picture = 0;
    int label = 0;
  };

private:
  void addBits(const std::uint16_t* labels, const std::set<std::uint16_t>& shown);

  std::string path_;
  CineInfo cine_;
  std::vector<ProbePose> poses_;
  std::vector<LabelInfo> labels_;
  std::vector<Frame> frames_;
  PictureTally tally_;
  std::fstream bits_;               ///< of all frames, one after the other without a gap
  std::uint8_t lastByte_ = 0;       ///< that is not full
  std::size_t lastBits_ = 0;        ///< in it
  std::vector<std::uint8_t> bytes_; ///< of one picture, kept for its room
};

} // namespace sono
