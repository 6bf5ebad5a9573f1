#include "Files/DicomHeader.h"

#include "Core/Error.h"
#include "Core/Version.h"
#include "Files/DicomItems.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

void putSeries(DcmItem& data, const CineInfo& info)
{
  putText(data, DCM_SOPClassUID, UID_UltrasoundMultiframeImageStorage);
  putText(data, DCM_SOPInstanceUID, info.ids.instance);
  putText(data, DCM_Modality, "US");
  putText(data, DCM_SeriesInstanceUID, info.ids.series);
  putText(data, DCM_SeriesNumber, "1");
  putText(data, DCM_SeriesDescription, "Simulated ultrasound");
  putText(data, DCM_Laterality, "");
  putText(data, DCM_PatientOrientation, "");
  putText(data, DCM_DerivationDescription,
          std::string("Simulated by SonoVDB ") + version() + " from labelled anatomy; nobody was scanned.");
  putText(data, DCM_BurnedInAnnotation, "NO");
}

void putPixels(DcmItem& data, const CineInfo& info)
{
  putWord(data, DCM_SamplesPerPixel, 1);
  putText(data, DCM_PhotometricInterpretation, "MONOCHROME2");
  putWord(data, DCM_Rows, info.height);
  putWord(data, DCM_Columns, info.width);
  putWord(data, DCM_BitsAllocated, 8);
  putWord(data, DCM_BitsStored, 8);
  putWord(data, DCM_HighBit, 7);
  putWord(data, DCM_PixelRepresentation, 0);
  putWord(data, DCM_UltrasoundColorDataPresent, 0);
  // Ultrasound has it in the region's calibration alone, where GDCM, and with it ITK and 3D Slicer, do not look:
  // between rows first.
  putNumbers(data, DCM_PixelSpacing, { info.pixelMm[1], info.pixelMm[0] });
}

void putTimes(DcmItem& data, const std::vector<double>& timesS)
{
  putText(data, DCM_NumberOfFrames, std::to_string(timesS.size()));
  const double frames = double(std::max<std::size_t>(timesS.size() - 1, 1));
  const double meanMs = 1000.0 * (timesS.back() - timesS.front()) / frames;
  std::string steps = "0";
  bool areEqual = true;
  for (std::size_t n = 1; n < timesS.size(); ++n)
  {
    const double stepMs = 1000.0 * (timesS[n] - timesS[n - 1]);
    if (!(stepMs > 0.0) || !std::isfinite(stepMs))
    {
      throw Error("Frame " + std::to_string(n + 1) + " is not later than the one before; set times that increase.");
    }
    areEqual = areEqual && std::abs(stepMs - meanMs) < 1e-6 * meanMs;
    steps += "\\" + dicomDecimal(stepMs);
  }
  const DcmTagKey tag = areEqual ? DCM_FrameTime : DCM_FrameTimeVector;
  putText(data, tag, areEqual ? dicomDecimal(meanMs) : steps);
  checkDicom(data.putAndInsertTagKey(DCM_FrameIncrementPointer, tag), DCM_FrameIncrementPointer);
  if (meanMs > 0.0)
  {
    putText(data, DCM_CineRate, std::to_string(std::max(1l, std::lround(1000.0 / meanMs))));
    putText(data, DCM_RecommendedDisplayFrameRate, std::to_string(std::max(1l, std::lround(1000.0 / meanMs))));
  }
}

void putTransducer(DcmItem& data, const ProbeSettings& probe)
{
  std::string parameters = std::string("scanKind=") + traitsOf(probe.geometry.kind).presetName;
  const auto add = [&](const auto& value, const Parameter& parameter) {
    parameters += std::string("\\") + parameter.name + "=" + dicomDecimal(numberOf(value));
  };
  ScanGeometry::visit(probe.geometry, [&](const auto& value, const Parameter& parameter) {
    if (parameter.choices.empty() && probe.geometry.uses(parameter))
    {
      add(value, parameter);
    }
  });
  ProbeSettings::visitPulse(probe, add);
  BeamAperture::visit(probe, add);
  ProbeSettings::visitElements(probe, add);
  putText(data, DCM_TransducerType, traitsOf(probe.geometry.kind).dicomType);
  putText(data, DCM_TransducerData, parameters);
  putText(data, DCM_DepthOfScanField, std::to_string(std::lround(probe.geometry.depthMm)));
}

/// US Region Calibration (PS3.3 C.8.5.5). Every pixel's place follows from the reference pixel and the spacing.
void putRegion(DcmItem& data, const CineInfo& info)
{
  DcmItem* region = nullptr;
  checkDicom(data.findOrCreateSequenceItem(DCM_SequenceOfUltrasoundRegions, region), DCM_SequenceOfUltrasoundRegions);
  putWord(*region, DCM_RegionSpatialFormat, 1); // 2D
  putWord(*region, DCM_RegionDataType, 1);      // tissue
  const auto number = [&](const DcmTagKey& tag, Uint32 value) {
    checkDicom(region->putAndInsertUint32(tag, value), tag);
  };
  number(DCM_RegionFlags, 0);
  number(DCM_RegionLocationMinX0, 0);
  number(DCM_RegionLocationMinY0, 0);
  number(DCM_RegionLocationMaxX1, Uint32(info.width - 1));
  number(DCM_RegionLocationMaxY1, Uint32(info.height - 1));
  number(DCM_TransducerFrequency, Uint32(std::lround(1000.0 * info.probe.centreFrequencyMHz)));
  struct Axis
  {
    DcmTagKey unit;
    DcmTagKey pixel;
    DcmTagKey value;
    DcmTagKey delta;
  };
  const Axis axes[] = {
    { DCM_PhysicalUnitsXDirection, DCM_ReferencePixelX0, DCM_ReferencePixelPhysicalValueX, DCM_PhysicalDeltaX },
    { DCM_PhysicalUnitsYDirection, DCM_ReferencePixelY0, DCM_ReferencePixelPhysicalValueY, DCM_PhysicalDeltaY }
  };
  constexpr double cmPerMm = 0.1;
  for (std::size_t n = 0; n < 2; ++n)
  {
    const long pixel = std::lround(-info.firstMm[n] / info.pixelMm[n]);
    const double valueMm = info.firstMm[n] + double(pixel) * info.pixelMm[n];
    putWord(*region, axes[n].unit, 3); // cm
    checkDicom(region->putAndInsertSint32(axes[n].pixel, Sint32(pixel)), axes[n].pixel);
    checkDicom(region->putAndInsertFloat64(axes[n].value, cmPerMm * valueMm), axes[n].value);
    checkDicom(region->putAndInsertFloat64(axes[n].delta, cmPerMm * info.pixelMm[n]), axes[n].delta);
  }
}

} // namespace

std::string dicomHeader(const CineInfo& info)
{
  DcmFileFormat file;
  DcmDataset& data = *file.getDataset();
  putOrigin(data, info);
  putSeries(data, info);
  putPixels(data, info);
  putTimes(data, info.timesS);
  putTransducer(data, info.probe);
  putRegion(data, info);
  return dicomBytes(file) + pixelDataStart(std::uint64_t(info.width) * std::uint64_t(info.height) * info.timesS.size());
}

} // namespace sono
