#include "vtkSonoDicomWriter.h"

#include "Core/Error.h"
#include "Files/DicomCine.h"
#include "SonoGreyImage.h"
#include "SonoProbeField.h"

#include "vtkImageData.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkSonoDicomWriter);

vtkSonoDicomWriter::vtkSonoDicomWriter()
{
  this->SetProgressText("Writing DICOM");
}

vtkSonoDicomWriter::~vtkSonoDicomWriter() = default;

void vtkSonoDicomWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "PatientName: " << this->PatientName << endl;
  os << indent << "PatientId: " << this->PatientId << endl;
}

std::string vtkSonoDicomWriter::NamelessRefusal() const
{
  return "No DICOM file is named; set FileName to one that ends in .dcm.";
}

void vtkSonoDicomWriter::Open(vtkImageData* image)
{
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
  info.timesS = this->TimesS(std::size_t(greys.count()));
  this->Cine = std::make_unique<sono::DicomCine>(this->GetFileName(), info);
}

void vtkSonoDicomWriter::AddStep(vtkImageData* image)
{
  const sono::GreySlices slices(image);
  for (int n = 0; n < slices.count(); ++n)
  {
    this->Cine->add(slices.at(n), slices.width(), slices.height());
    this->Tell(double(n + 1) / slices.count());
  }
}

void vtkSonoDicomWriter::Finish()
{
  this->Cine->finish();
}

void vtkSonoDicomWriter::Close()
{
  this->Cine.reset();
}
