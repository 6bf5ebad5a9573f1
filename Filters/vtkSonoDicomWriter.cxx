#include "vtkSonoDicomWriter.h"

#include "Core/Progress.h"
#include "Core/Require.h"
#include "Files/DicomCine.h"
#include "Image/ScanConvert.h"
#include "SonoProbeField.h"
#include "SonoStage.h"

#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

vtkStandardNewMacro(vtkSonoDicomWriter);

namespace {

using Pipeline = vtkStreamingDemandDrivenPipeline;

constexpr double usualFrameTimeMs = 40.0;

vtkUnsignedCharArray* greysOf(vtkImageData* image)
{
  auto* greys = vtkUnsignedCharArray::SafeDownCast(image->GetPointData()->GetArray("BMode"));
  if (!greys || greys->GetNumberOfComponents() != 1)
  {
    throw sono::Error("The image has no point array 'BMode' of unsigned char; connect an image of Simulate Ultrasound, "
                      "Scan Conversion or Ultrasound Sweep.");
  }
  return greys;
}

/// Where the image's pixels lie, whether it is flat or in the world: as the probe's own picture has them.
sono::CineInfo cineOf(vtkImageData* image)
{
  sono::CineInfo info;
  info.probe = sono::readProbe(image->GetFieldData());
  int size[3];
  image->GetDimensions(size);
  info.width = size[0];
  info.height = size[1];
  const double pixelMm = image->GetSpacing()[0];
  info.pixelMm = { pixelMm, pixelMm };
  if (!info.probe.geometry.isVolume())
  {
    const sono::PlaneImage layout = sono::planeImageLayout(info.probe.geometry, pixelMm);
    if (layout.width != size[0] || layout.height != size[1])
    {
      throw sono::Error("The image is " + std::to_string(size[0]) + " x " + std::to_string(size[1]) +
                        " pixels and its probe scans " + std::to_string(layout.width) + " x " +
                        std::to_string(layout.height) + "; connect the whole image, not cut or resampled.");
    }
    info.firstMm = { layout.lateralMinMm, layout.axialMinMm };
  }
  return info;
}

} // namespace

vtkSonoDicomWriter::vtkSonoDicomWriter()
{
  this->SetProgressText("Writing DICOM");
}

vtkSonoDicomWriter::~vtkSonoDicomWriter() = default;

void vtkSonoDicomWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << endl;
  os << indent << "FrameTimeMs: " << this->FrameTimeMs << endl;
  os << indent << "PatientName: " << this->PatientName << endl;
  os << indent << "PatientId: " << this->PatientId << endl;
}

int vtkSonoDicomWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

vtkTypeBool vtkSonoDicomWriter::ProcessRequest(vtkInformation* request, vtkInformationVector** input,
                                               vtkInformationVector* output)
{
  vtkInformation* inInfo = input[0]->GetInformationObject(0);
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_INFORMATION()))
  {
    const int count = inInfo->Has(Pipeline::TIME_STEPS()) ? inInfo->Length(Pipeline::TIME_STEPS()) : 0;
    const double* times = inInfo->Get(Pipeline::TIME_STEPS());
    this->StepTimes.assign(times, times + count);
    this->NextStep = 0;
    this->Cine.reset();
    return 1;
  }
  if (request->Has(Pipeline::REQUEST_UPDATE_EXTENT()))
  {
    if (this->NextStep < this->StepTimes.size())
    {
      inInfo->Set(Pipeline::UPDATE_TIME_STEP(), this->StepTimes[this->NextStep]);
    }
    return sono::requestWholeImage(input);
  }
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_DATA()))
  {
    request->Remove(Pipeline::CONTINUE_EXECUTING());
    this->WriteData();
    if (this->Cine)
    {
      request->Set(Pipeline::CONTINUE_EXECUTING(), 1);
    }
    return 1;
  }
  return this->Superclass::ProcessRequest(request, input, output);
}

void vtkSonoDicomWriter::Begin(vtkImageData* image)
{
  sono::requireInRange(sono::between(0, 100000).contains(this->FrameTimeMs), "FrameTimeMs", this->FrameTimeMs,
                       "between 0 and 100000");
  if (this->FileName.empty())
  {
    throw sono::Error("No DICOM file is named; set FileName to one that ends in .dcm.");
  }
  sono::CineInfo info = cineOf(image);
  info.patientName = this->PatientName;
  info.patientId = this->PatientId;
  const auto slices = static_cast<std::size_t>(image->GetDimensions()[2]);
  const std::size_t frames = slices * std::max<std::size_t>(this->StepTimes.size(), 1);
  const bool timesAreSaid = this->FrameTimeMs == 0.0 && this->StepTimes.size() > 1 && slices == 1;
  const double stepMs = this->FrameTimeMs > 0.0 ? this->FrameTimeMs : usualFrameTimeMs;
  for (std::size_t n = 0; n < frames; ++n)
  {
    info.timesS.push_back(timesAreSaid ? this->StepTimes[n] : 1e-3 * stepMs * double(n));
  }
  this->Cine = std::make_unique<sono::DicomCine>(this->FileName, info);
}

void vtkSonoDicomWriter::AddFrames(vtkImageData* image)
{
  int size[3];
  image->GetDimensions(size);
  const unsigned char* grey = greysOf(image)->GetPointer(0);
  const sono::Progress progress = sono::progressOf(this);
  const double steps = double(std::max<std::size_t>(this->StepTimes.size(), 1));
  for (int slice = 0; slice < size[2]; ++slice)
  {
    this->Cine->add(grey + std::ptrdiff_t(slice) * size[0] * size[1], size[0], size[1]);
    if (!progress((double(this->NextStep) + double(slice + 1) / size[2]) / steps))
    {
      throw sono::Aborted();
    }
  }
}

void vtkSonoDicomWriter::WriteData()
{
  bool isWritten = false;
  const bool isRun = sono::runWork(this, [&] {
    if (this->GetAbortOutput())
    {
      throw sono::Aborted(); // the input was stopped, or has said why there is none
    }
    vtkImageData* image = vtkImageData::SafeDownCast(this->GetInput());
    if (this->NextStep == 0)
    {
      greysOf(image);
      this->Begin(image);
    }
    this->AddFrames(image);
    ++this->NextStep;
    if (this->NextStep >= this->StepTimes.size())
    {
      this->Cine->finish();
      this->Cine.reset();
    }
    isWritten = true;
  });
  this->SetErrorCode(isWritten ? vtkErrorCode::NoError : vtkErrorCode::CannotOpenFileError);
  if (!isWritten)
  {
    this->Cine.reset();
    if (isRun)
    {
      sono::warn(this, "Stopped: '" + this->FileName + "' was not written; save it again.");
    }
  }
}
