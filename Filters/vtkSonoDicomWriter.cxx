#include "vtkSonoDicomWriter.h"

#include "Core/Progress.h"
#include "Files/DicomCine.h"
#include "Image/ScanConvert.h"
#include "SonoProbeField.h"
#include "SonoTimeSteps.h"

#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

vtkStandardNewMacro(vtkSonoDicomWriter);

namespace {

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
  : Steps(new sono::TimeSteps)
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
  const sono::StepWork work{ [this](vtkImageData* image) { this->Begin(image); },
                             [this](vtkImageData* image) { this->AddFrames(image); }, [this] { this->Cine->finish(); },
                             [this](bool isWritten) {
                               this->Cine.reset();
                               this->SetErrorCode(isWritten ? vtkErrorCode::NoError
                                                            : vtkErrorCode::CannotOpenFileError);
                             } };
  return this->Steps->process(this, this->FileName, work, request, input)
           ? 1
           : this->Superclass::ProcessRequest(request, input, output);
}

void vtkSonoDicomWriter::Begin(vtkImageData* image)
{
  if (this->FileName.empty())
  {
    throw sono::Error("No DICOM file is named; set FileName to one that ends in .dcm.");
  }
  greysOf(image);
  sono::CineInfo info = cineOf(image);
  info.patientName = this->PatientName;
  info.patientId = this->PatientId;
  info.timesS = sono::frameTimesS(*this->Steps, std::size_t(image->GetDimensions()[2]), this->FrameTimeMs);
  this->Cine = std::make_unique<sono::DicomCine>(this->FileName, info);
}

void vtkSonoDicomWriter::AddFrames(vtkImageData* image)
{
  int size[3];
  image->GetDimensions(size);
  const unsigned char* grey = greysOf(image)->GetPointer(0);
  for (int slice = 0; slice < size[2]; ++slice)
  {
    this->Cine->add(grey + std::ptrdiff_t(slice) * size[0] * size[1], size[0], size[1]);
    this->Steps->tell(this, double(slice + 1) / size[2]);
  }
}
