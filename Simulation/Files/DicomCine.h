#pragma once

#include "Files/DicomIds.h"
#include "Probe/ScanGeometry.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace sono {

class GreyFrames;

/// What there is to say of a sequence of pictures besides their greys.
struct CineInfo
{
  ProbeSettings probe; ///< of a kind that scans a plane
  int width = 0;
  int height = 0;
  std::array<double, 2> pixelMm{ 1.0, 1.0 }; ///< along the array and into the body
  std::array<double, 2> firstMm{ 0.0, 0.0 }; ///< middle of the first pixel from that of the face, as it is shown
  std::vector<double> timesS;                ///< of each picture, in increasing order
  std::string patientName;                   ///< as DICOM has it, family^given, in UTF-8; may be empty
  std::string patientId;
  DicomIds ids = freshDicomIds();
};

/// A DICOM file of pictures: an Ultrasound Multi-frame Image (PS3.3 A.7), 8-bit greys, not compressed, with
/// - a region calibration: all pixels, in cm, from the middle of the transducer's face, which is the reference pixel;
/// - the time between two frames, or each of the times where they differ;
/// - the kind of transducer, its depth, and as Transducer Data its parameters, name=value (sectorDeg=75);
/// - "Simulated" in the manufacturer, the series and the derivation; fresh UIDs below 2.25 (ITU-T X.667).
/// The pictures are written one by one, so that their number does not ask for memory; the file appears when all are
/// there, or not at all.
class DicomCine
{
public:
  /// Throws Error naming the path where it cannot be written, there are no pictures, a volume, or more than 4 GB.
  DicomCine(const std::string& path, const CineInfo& info);
  ~DicomCine();

  /// The next picture, the row at the face first. Throws Error for another size, one too many, and a full disk.
  void add(const std::uint8_t* grey, int width, int height);
  /// Throws Error where pictures are missing, or the disk is full.
  void finish();

private:
  std::unique_ptr<GreyFrames> frames_;
  std::string padding_;
};

} // namespace sono
