#include "SonoOutputs.h"

#include "SonoImagePlacement.h"
#include "SonoLabelImage.h"
#include "SonoLineImage.h"
#include "SonoSharedArray.h"
#include "vtkSonoResultHandle.h"

#include "vtkCellArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedShortArray.h"

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>

namespace sono {
namespace {

constexpr const char* radialBinName = "RadialBinMm"; // of the depth offsets

/// Where an array of traced lines is kept: in the field data it goes on to the stages behind.
vtkFieldData* placeOf(TracedAxis axis, vtkImageData* lines)
{
  return axis == TracedAxis::Bins ? lines->GetPointData() : lines->GetFieldData();
}

/// The arrays that traced lines are, by the names of the point data and of the field data.
std::vector<vtkAbstractArray*> tracedArrays(vtkImageData* lines)
{
  std::vector<vtkAbstractArray*> arrays;
  TracedLines layout;
  TracedLines::visitArrays(layout, [&](const auto&, const char* name, TracedAxis axis) {
    arrays.push_back(placeOf(axis, lines)->GetAbstractArray(name));
  });
  return arrays;
}

std::vector<vtkAbstractArray*> rfArrays(vtkImageData* image)
{
  return { image->GetPointData()->GetAbstractArray("Envelope") };
}

std::vector<vtkAbstractArray*> bmodeArrays(vtkImageData* image)
{
  return { image->GetPointData()->GetAbstractArray("BMode") };
}

template<class Result>
Result found(const std::vector<vtkAbstractArray*>& arrays, vtkImageData* image)
{
  const Result* result = vtkSonoResultHandle::Find<Result>(arrays, image->GetFieldData());
  return result ? *result : Result();
}

void addTraced(const TracedResult& traced, vtkImageData* lines)
{
  TracedLines::visitArrays(traced.host(), [&](const auto& values, const char* name, TracedAxis axis) {
    placeOf(axis, lines)->AddArray(lineArray(name, values));
  });
  writeNumber(radialBinName, traced.layout().binMm, lines->GetFieldData());
  lines->GetPointData()->SetActiveScalars("Intensity");
}

void addRf(const RfResult& rf, vtkImageData* image)
{
  const RfLines& lines = rf.host();
  const std::vector<float> envelope = lines.envelope();
  const auto array = lineArray("Envelope", envelope);
  if (!envelope.empty())
  {
    const auto [low, high] = std::minmax_element(envelope.begin(), envelope.end());
    tellRange(*low, *high, array); // an A-line asks for it with each picture
  }
  image->GetPointData()->SetScalars(array);
  image->GetPointData()->AddArray(lineArray("RF", lines.rf()));
  image->GetPointData()->AddArray(lineArray("IQ", lines.iq));
}

void addBMode(const BModeResult& bmode, vtkImageData* image)
{
  const BModeLines& lines = bmode.host();
  image->GetPointData()->SetScalars(lineArray("BMode", lines.grey));
  writeNumber("ReferenceAmplitude", lines.referenceAmplitude, image->GetFieldData());
}

ImagePlacement placementOf(const ImageResult& image, const ProbePose& pose)
{
  return image.isVolume() ? ImagePlacement(image.volume(), pose) : ImagePlacement(image.plane().layout(), pose);
}

} // namespace

void fillProbe(const ProbeField& probe, vtkPolyData* polyData)
{
  const ProbePose& pose = probe.pose;
  const Vec3d elevation = glm::cross(pose.axial, pose.lateral);
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  for (const std::vector<Vec3d>& polyline : scanOutline(probe.geometry))
  {
    lines->InsertNextCell(static_cast<int>(polyline.size()));
    for (const Vec3d& p : polyline)
    {
      const Vec3d world = pose.positionMm + p.x * pose.lateral + p.y * elevation + p.z * pose.axial;
      lines->InsertCellPoint(points->InsertNextPoint(&world.x));
    }
  }
  polyData->SetPoints(points);
  polyData->SetLines(lines);
  writeProbe(probe, polyData->GetFieldData());
}

void writeReached(const TracedLines& layout, vtkFieldData* fields)
{
  writeNumber("TracedPaths", layout.paths, fields);
  if (layout.errorDb > 0.0)
  {
    writeNumber("ErrorDb", layout.errorDb, fields);
  }
}

void writeGreySettings(const BModeSettings& settings, vtkFieldData* fields)
{
  writeNumber("GainDb", settings.gainDb, fields);
  writeNumber("DynamicRangeDb", settings.dynamicRangeDb, fields);
  writeNumber("TgcDbPerCm", settings.tgcDbPerCm, fields);
}

void fillTraced(const TracedResult& traced, const ProbeField& probe, double samplingMHz, vtkImageData* lines)
{
  const TracedLines& layout = traced.layout();
  setLineImageLayout({ layout.binCount, layout.lineCount, layout.binMm / 2.0, layout.binMm }, lines);
  writeProbe(probe, lines->GetFieldData());
  writeNumber("SamplingMHz", samplingMHz, lines->GetFieldData());
  writeReached(layout, lines->GetFieldData());
  addTraced(traced, lines);
  vtkSonoResultHandle::Attach(traced, tracedArrays(lines), lines->GetFieldData());
}

void fillEchoes(const TracedResult& traced, const ProbeField& probe, vtkImageData* lines, vtkImageData* echoes)
{
  const TracedLines& layout = traced.layout();
  setLineImageLayout(shownLayout(probe.geometry, layout.echoCount, layout.echoSampleMm), echoes);
  TracedLines::visitArrays(layout, [&](const auto&, const char* name, TracedAxis axis) {
    if (axis == TracedAxis::EchoSamples)
    {
      echoes->GetPointData()->AddArray(lines->GetFieldData()->GetArray(name));
    }
  });
  echoes->GetPointData()->SetActiveScalars("BoundaryEcho");
}

TracedResult tracedOf(vtkImageData* lines, const ProbeField& probe, double echoSampleMm)
{
  const LineImageLayout layout = lineImageLayout(lines, probe.geometry.totalLineCount());
  const TracedResult handle = tracedHandleOf(lines);
  if (handle && handle.layout().lineCount == layout.lineCount && handle.layout().binCount == layout.sampleCount)
  {
    return handle;
  }
  const std::size_t count = std::size_t(layout.lineCount) * layout.sampleCount;
  TracedLines traced = rangeArraysOf(lines, layout.lineCount);
  traced.binCount = layout.sampleCount;
  traced.binMm = layout.sampleMm;
  TracedLines::visitArrays(traced, [&](auto& values, const char* name, TracedAxis axis) {
    vtkFieldData* from = placeOf(axis, lines);
    if constexpr (std::is_same_v<std::decay_t<decltype(values)>, std::vector<float>>)
    {
      if (axis == TracedAxis::Bins)
      {
        values = lineValues(name, from, count);
      }
    }
    else
    {
      values = complexLineValues(name, from);
    }
  });
  traced.echoCount = static_cast<int>(traced.boundaryEcho.size() / layout.lineCount);
  traced.echoSampleMm = echoSampleMm;
  // In that model alone paths bring boundaries, and range is depth.
  traced.model =
    traced.echoCount > 0 && traced.depthOffsetMm.empty() ? InterfaceModel::Amadou2024 : InterfaceModel::Acoustic;
  return TracedResult(std::move(traced));
}

TracedLines rangeArraysOf(vtkImageData* lines, int lineCount)
{
  TracedLines traced;
  traced.lineCount = lineCount;
  TracedLines::visitArrays(traced, [&](auto& values, const char* name, TracedAxis axis) {
    if constexpr (std::is_same_v<std::decay_t<decltype(values)>, std::vector<float>>)
    {
      vtkDataArray* array = lines->GetFieldData()->GetArray(name);
      if (axis == TracedAxis::RangeBins && array && array->GetNumberOfTuples() > 0)
      {
        traced.binMm = readNumber(radialBinName, lines->GetFieldData());
        traced.binCount = static_cast<int>(array->GetNumberOfTuples() / lineCount);
        values = lineValues(name, lines->GetFieldData(), std::size_t(lineCount) * std::size_t(traced.binCount));
      }
    }
  });
  return traced;
}

TracedResult tracedHandleOf(vtkImageData* lines)
{
  return found<TracedResult>(tracedArrays(lines), lines);
}

void fillRf(const RfResult& rf, const ProbeField& probe, vtkImageData* image)
{
  const RfLines& layout = rf.layout();
  setLineImageLayout(shownLayout(probe.geometry, layout.sampleCount, layout.sampleMm), image);
  image->GetFieldData()->RemoveArray("BoundaryEcho"); // it came along from the input and is part of RF now
  addRf(rf, image);
  vtkSonoResultHandle::Attach(rf, rfArrays(image), image->GetFieldData());
}

RfResult rfOf(vtkImageData* image)
{
  return found<RfResult>(rfArrays(image), image);
}

void fillBMode(const BModeResult& bmode, const ProbeField& probe, vtkImageData* image)
{
  const BModeLines& layout = bmode.layout();
  setLineImageLayout(shownLayout(probe.geometry, layout.sampleCount, layout.sampleMm), image);
  addBMode(bmode, image);
  vtkSonoResultHandle::Attach(bmode, bmodeArrays(image), image->GetFieldData());
}

BModeResult bmodeOf(vtkImageData* image)
{
  return found<BModeResult>(bmodeArrays(image), image);
}

void placeImage(const ImageResult& image, const ProbePose& pose, vtkImageData* world)
{
  world->GetPointData()->Initialize(); // VTK keeps the scalars of the run before
  placementOf(image, pose).place(world);
  vtkSonoResultHandle::Remove(world->GetFieldData());
}

void placeFlat(const ImageResult& image, const ProbePose& pose, vtkImageData* world, vtkImageData* flat)
{
  flat->ShallowCopy(world);
  placementOf(image, pose).flat(pose).place(flat);
}

namespace {

/// A shared array that knows its range: whoever shows it asks for that, and VTK takes longer to look than to draw it.
template<class Array, class T>
vtkSmartPointer<Array> rangedArray(const char* name, const SharedSpan<T>& values)
{
  const auto array = sharedArray<Array>(name, values);
  T low = values.size > 0 ? values[0] : T(0);
  T high = low;
  for (const T value : values)
  {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  tellRange(double(low), double(high), array);
  return array;
}

} // namespace

vtkSmartPointer<vtkPointData> pictureArrays(const ScanPicture& picture)
{
  auto arrays = vtkSmartPointer<vtkPointData>::New();
  arrays->SetScalars(rangedArray<vtkUnsignedCharArray>("BMode", picture.grey));
  arrays->AddArray(rangedArray<vtkUnsignedCharArray>("Mask", picture.mask));
  if (picture.labels.size > 0)
  {
    arrays->AddArray(rangedArray<vtkUnsignedShortArray>("Labels", picture.labels));
  }
  return arrays;
}

vtkSmartPointer<vtkPointData> errorArrays(const ImageResult& map)
{
  const std::vector<float>& value = map.isVolume() ? map.volume().value : map.plane().host().value;
  const std::vector<std::uint8_t>& mask = map.isVolume() ? map.volume().mask : map.plane().host().mask;
  std::vector<float> percent(value.size());
  for (std::size_t i = 0; i < value.size(); ++i)
  {
    percent[i] = mask[i] ? value[i] : std::numeric_limits<float>::quiet_NaN();
  }
  auto arrays = vtkSmartPointer<vtkPointData>::New();
  arrays->SetScalars(sharedArray<vtkFloatArray>("ErrorPercent", SharedSpan<float>(std::move(percent))));
  arrays->AddArray(sharedArray<vtkUnsignedCharArray>("Mask", SharedSpan<std::uint8_t>(mask)));
  return arrays;
}

} // namespace sono
