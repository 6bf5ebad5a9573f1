#pragma once

#include <string>

namespace sono {

/// What ties DICOM files to one study and one image: fresh UIDs below 2.25 (ITU-T X.667) and the time of now.
struct DicomIds
{
  std::string study;
  std::string series;
  std::string instance;
  std::string frameOfReference; ///< of the label map's world
  std::string date;             ///< YYYYMMDD
  std::string time;             ///< HHMMSS
};

DicomIds freshDicomIds();

/// A UUID of random bits as a UID (PS3.5 B.2): 128 bits as one decimal number.
std::string freshDicomUid();

} // namespace sono
