#include "vtkSonoDicomWriter.h"

#include "Core/Progress.h"
#include "Files/DicomCine.h"
#include "SonoGreyImage.h"
#include "SonoProbeField.h"
#include "SonoTimeSteps.h"

#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkSonoDicomWriter);

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
  const sono::GreySlices greys(image); // the first that may be missing
  sono::CineInfo info;
  info.probe = sono::readProbe(image->GetFieldData());
  const sono::GreyLayout layout = sono::greyLayout(image, info.probe.geometry);
  info.width = layout.width;
  info.height = layout.height;
  info.pixelMm = { layout.pixelMm, layout.pixelMm };
  info.firstMm = layout.firstMm;
  info.patientName = this->PatientName;
  info.patientId = this->PatientId;
  info.timesS = sono::frameTimesS(*this->Steps, std::size_t(greys.count()), this->FrameTimeMs);
  this->Cine = std::make_unique<sono::DicomCine>(this->FileName, info);
}

void vtkSonoDicomWriter::AddFrames(vtkImageData* image)
{
  const sono::GreySlices slices(image);
  for (int n = 0; n < slices.count(); ++n)
  {
    this->Cine->add(slices.at(n), slices.width(), slices.height());
    this->Steps->tell(this, double(n + 1) / slices.count());
  }
}
