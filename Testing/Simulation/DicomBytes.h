#pragma once

#include <dcmtk/config/osconfig.h>

#include <dcmtk/dcmdata/dcrleerg.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

namespace sono::testing {

/// A frame of a segmentation: which segment, where its first pixel lies, and its pixels.
struct SegFrame
{
  int segment;
  std::string position; ///< x\y\z, LPS mm
  std::vector<std::uint8_t> pixels;
};

/// Small DICOM files, put together element by element.
class DicomBytes
{
public:
  DicomBytes(const std::string& modality, int columns, int rows)
  {
    DcmRLEEncoderRegistration::registerCodecs();
    put(DCM_SOPClassUID, modality == "SEG" ? UID_SegmentationStorage : UID_CTImageStorage);
    put(DCM_SOPInstanceUID, "1.2.3.4." + std::to_string(++count_));
    put(DCM_SeriesInstanceUID, "1.2.3");
    put(DCM_SpecificCharacterSet, "ISO_IR 100");
    put(DCM_Modality, modality);
    number(DCM_Columns, columns);
    number(DCM_Rows, rows);
    number(DCM_SamplesPerPixel, 1);
    put(DCM_PhotometricInterpretation, "MONOCHROME2");
  }

  DicomBytes& put(const DcmTagKey& tag, const std::string& value)
  {
    EXPECT_TRUE(data().putAndInsertString(tag, value.c_str()).good());
    return *this;
  }
  DicomBytes& number(const DcmTagKey& tag, int value)
  {
    EXPECT_TRUE(data().putAndInsertUint16(tag, Uint16(value)).good());
    return *this;
  }
  DicomBytes& bits(int allocated, int stored, bool isSigned)
  {
    number(DCM_BitsAllocated, allocated).number(DCM_BitsStored, stored).number(DCM_HighBit, stored - 1);
    return number(DCM_PixelRepresentation, isSigned ? 1 : 0);
  }

  /// A slice of a scan.
  DicomBytes& slice(const std::string& position, const std::vector<std::uint16_t>& words)
  {
    put(DCM_ImagePositionPatient, position);
    put(DCM_ImageOrientationPatient, "1\\0\\0\\0\\1\\0");
    put(DCM_PixelSpacing, "3\\2"); // rows 3 mm apart, columns 2 mm
    EXPECT_TRUE(data().putAndInsertUint16Array(DCM_PixelData, words.data(), words.size()).good());
    return *this;
  }

  /// Segment `id` with a name in Latin-1, a code and a colour (CIELab in 16 bits).
  DicomBytes& segment(int id, const std::string& name, const std::string& code, const std::vector<Uint16>& lab = {})
  {
    DcmItem* item = nullptr;
    data().findOrCreateSequenceItem(DCM_SegmentSequence, item, -2);
    item->putAndInsertUint16(DCM_SegmentNumber, Uint16(id));
    item->putAndInsertString(DCM_SegmentLabel, name.c_str());
    if (!lab.empty())
    {
      item->putAndInsertUint16Array(DCM_RecommendedDisplayCIELabValue, lab.data(), 3);
    }
    DcmItem* type = nullptr;
    item->findOrCreateSequenceItem(DCM_SegmentedPropertyTypeCodeSequence, type, 0);
    type->putAndInsertString(DCM_CodeValue, code.c_str());
    type->putAndInsertString(DCM_CodingSchemeDesignator, "SCT");
    return *this;
  }

  /// The frames of a segmentation with pixels of 1 or 8 bits; i runs along +y, j along -x, so k along +z.
  DicomBytes& frames(const std::string& type, const std::vector<SegFrame>& list)
  {
    const bool binary = type == "BINARY";
    put(DCM_SegmentationType, type).put(DCM_NumberOfFrames, std::to_string(list.size()));
    bits(binary ? 1 : 8, binary ? 1 : 8, false);
    number(DCM_MaximumFractionalValue, 200);
    DcmItem* shared = nullptr;
    DcmItem* part = nullptr;
    data().findOrCreateSequenceItem(DCM_SharedFunctionalGroupsSequence, shared, 0);
    shared->findOrCreateSequenceItem(DCM_PlaneOrientationSequence, part, 0);
    part->putAndInsertString(DCM_ImageOrientationPatient, "0\\1\\0\\-1\\0\\0");
    shared->findOrCreateSequenceItem(DCM_PixelMeasuresSequence, part, 0);
    part->putAndInsertString(DCM_PixelSpacing, "3\\2");
    part->putAndInsertString(DCM_SpacingBetweenSlices, "4");
    std::vector<std::uint8_t> pixels;
    for (const SegFrame& frame : list)
    {
      DcmItem* group = nullptr;
      data().findOrCreateSequenceItem(DCM_PerFrameFunctionalGroupsSequence, group, -2);
      group->findOrCreateSequenceItem(DCM_PlanePositionSequence, part, 0);
      part->putAndInsertString(DCM_ImagePositionPatient, frame.position.c_str());
      if (type != "LABELMAP")
      {
        group->findOrCreateSequenceItem(DCM_SegmentIdentificationSequence, part, 0);
        part->putAndInsertUint16(DCM_ReferencedSegmentNumber, Uint16(frame.segment));
      }
      pixels.insert(pixels.end(), frame.pixels.begin(), frame.pixels.end());
    }
    if (binary)
    {
      std::vector<std::uint8_t> packed((pixels.size() + 7) / 8, 0); // the first pixel in the lowest bit
      for (std::size_t n = 0; n < pixels.size(); ++n)
      {
        packed[n / 8] = std::uint8_t(packed[n / 8] | (pixels[n] != 0 ? 1 << (n % 8) : 0));
      }
      pixels = packed;
    }
    pixels.resize((pixels.size() + 1) / 2 * 2);
    EXPECT_TRUE(data().putAndInsertUint8Array(DCM_PixelData, pixels.data(), pixels.size()).good());
    return *this;
  }

  void write(const std::string& path, E_TransferSyntax syntax = EXS_LittleEndianExplicit)
  {
    EXPECT_TRUE(data().chooseRepresentation(syntax, nullptr).good());
    EXPECT_TRUE(file_.saveFile(path.c_str(), syntax).good());
  }

  DcmDataset& data() { return *file_.getDataset(); }

private:
  DcmFileFormat file_;
  static inline int count_ = 0;
};

} // namespace sono::testing
