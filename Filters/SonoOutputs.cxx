#include "SonoOutputs.h"

#include "SonoImagePlacement.h"
#include "SonoLineImage.h"
#include "SonoSharedArray.h"
#include "vtkSonoResultHandle.h"

#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedShortArray.h"

#include <limits>
#include <type_traits>

namespace sono {
namespace {

/// The arrays that traced lines are, by the names of the point data and of the field data.
std::vector<vtkAbstractArray*> tracedArrays(vtkImageData* lines)
{
  std::vector<vtkAbstractArray*> arrays;
  TracedLines layout;
  TracedLines::visitArrays(layout, [&](const auto&, const char* name, TracedAxis axis) {
    vtkFieldData* from = axis == TracedAxis::Bins ? lines->GetPointData() : lines->GetFieldData();
    arrays.push_back(from->GetAbstractArray(name));
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
    vtkFieldData* to = axis == TracedAxis::Bins ? lines->GetPointData() : lines->GetFieldData();
    to->AddArray(lineArray(name, values));
  });
  lines->GetPointData()->SetActiveScalars("Intensity");
}

void addRf(const RfResult& rf, vtkImageData* image)
{
  const RfLines& lines = rf.host();
  image->GetPointData()->SetScalars(lineArray("Envelope", lines.envelope()));
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

void fillTraced(const TracedResult& traced, const ProbeField& probe, double samplingMHz, Carries carries,
                vtkImageData* lines)
{
  const TracedLines& layout = traced.layout();
  setLineImageLayout({ layout.binCount, layout.lineCount, layout.binMm / 2.0, layout.binMm }, lines);
  writeProbe(probe, lines->GetFieldData());
  writeNumber("SamplingMHz", samplingMHz, lines->GetFieldData());
  if (carries == Carries::Arrays)
  {
    addTraced(traced, lines);
  }
  vtkSonoResultHandle::Attach(traced, tracedArrays(lines), lines->GetFieldData());
}

void fillEchoes(const TracedResult& traced, vtkImageData* lines, vtkImageData* echoes)
{
  const TracedLines& layout = traced.layout();
  setLineImageLayout({ layout.echoCount, layout.lineCount, 0.0, layout.echoSampleMm }, echoes);
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
  TracedLines traced;
  traced.lineCount = layout.lineCount;
  traced.binCount = layout.sampleCount;
  traced.binMm = layout.sampleMm;
  TracedLines::visitArrays(traced, [&](auto& values, const char* name, TracedAxis axis) {
    vtkFieldData* from = axis == TracedAxis::Bins ? lines->GetPointData() : lines->GetFieldData();
    if constexpr (std::is_same_v<std::decay_t<decltype(values)>, std::vector<float>>)
    {
      values = lineValues(name, from, count);
    }
    else
    {
      values = complexLineValues(name, from);
    }
  });
  traced.echoCount = static_cast<int>(traced.boundaryEcho.size() / layout.lineCount);
  traced.echoSampleMm = echoSampleMm;
  // Paths bring boundaries in that model alone.
  traced.model = traced.echoCount > 0 ? InterfaceModel::Amadou2024 : InterfaceModel::Acoustic;
  return TracedResult(std::move(traced));
}

TracedResult tracedHandleOf(vtkImageData* lines)
{
  return found<TracedResult>(tracedArrays(lines), lines);
}

void fillRf(const RfResult& rf, Carries carries, vtkImageData* image)
{
  const RfLines& layout = rf.layout();
  setLineImageLayout({ layout.sampleCount, layout.lineCount, 0.0, layout.sampleMm }, image);
  image->GetFieldData()->RemoveArray("BoundaryEcho"); // it came along from the input and is part of RF now
  if (carries == Carries::Arrays)
  {
    addRf(rf, image);
  }
  vtkSonoResultHandle::Attach(rf, rfArrays(image), image->GetFieldData());
}

RfResult rfOf(vtkImageData* image)
{
  return found<RfResult>(rfArrays(image), image);
}

void fillBMode(const BModeResult& bmode, Carries carries, vtkImageData* image)
{
  const BModeLines& layout = bmode.layout();
  setLineImageLayout({ layout.sampleCount, layout.lineCount, 0.0, layout.sampleMm }, image);
  if (carries == Carries::Arrays)
  {
    addBMode(bmode, image);
  }
  vtkSonoResultHandle::Attach(bmode, bmodeArrays(image), image->GetFieldData());
}

BModeResult bmodeOf(vtkImageData* image)
{
  return found<BModeResult>(bmodeArrays(image), image);
}

void addArrays(vtkImageData* image)
{
  if (image->GetPointData()->GetNumberOfArrays() > 0)
  {
    return;
  }
  if (const RfResult rf = rfOf(image))
  {
    addRf(rf, image);
    vtkSonoResultHandle::Attach(rf, rfArrays(image), image->GetFieldData());
  }
  else if (const BModeResult bmode = bmodeOf(image))
  {
    addBMode(bmode, image);
    vtkSonoResultHandle::Attach(bmode, bmodeArrays(image), image->GetFieldData());
  }
  else if (const TracedResult traced = tracedHandleOf(image))
  {
    addTraced(traced, image);
    vtkSonoResultHandle::Attach(traced, tracedArrays(image), image->GetFieldData());
  }
}

void fillImage(const ImageResult& image, const ScanPicture& picture, const ProbePose& pose, vtkImageData* world,
               vtkImageData* flat)
{
  const ImagePlacement placement = placementOf(image, pose);
  placement.place(world);
  vtkPointData* arrays = world->GetPointData();
  arrays->SetScalars(sharedArray<vtkUnsignedCharArray>("BMode", picture.grey));
  arrays->AddArray(sharedArray<vtkUnsignedCharArray>("Mask", picture.mask));
  if (picture.labels.size > 0)
  {
    arrays->AddArray(sharedArray<vtkUnsignedShortArray>("Labels", picture.labels));
  }
  vtkSonoResultHandle::Remove(world->GetFieldData());
  flat->ShallowCopy(world);
  placement.flat(pose).place(flat);
}

void fillErrorMap(const ImageResult& map, const ProbePose& pose, vtkImageData* world, vtkImageData* flat)
{
  const std::vector<float>& value = map.isVolume() ? map.volume().value : map.plane().host().value;
  const std::vector<std::uint8_t>& mask = map.isVolume() ? map.volume().mask : map.plane().host().mask;
  std::vector<float> percent(value.size());
  for (std::size_t i = 0; i < value.size(); ++i)
  {
    percent[i] = mask[i] ? value[i] : std::numeric_limits<float>::quiet_NaN();
  }
  const ImagePlacement placement = placementOf(map, pose);
  placement.place(world);
  world->GetPointData()->SetScalars(sharedArray<vtkFloatArray>("ErrorPercent", SharedSpan<float>(std::move(percent))));
  world->GetPointData()->AddArray(sharedArray<vtkUnsignedCharArray>("Mask", SharedSpan<std::uint8_t>(mask)));
  vtkSonoResultHandle::Remove(world->GetFieldData());
  flat->ShallowCopy(world);
  placement.flat(pose).place(flat);
}

} // namespace sono
