#include "vtkSonoDicomWriter.h"

#include "Core/EndsWith.h"
#include "Core/Error.h"
#include "Files/DicomCine.h"
#include "Files/DicomMasks.h"
#include "SonoGreyImage.h"
#include "SonoLabelImage.h"
#include "SonoPoses.h"
#include "SonoProbeField.h"

#include "vtkImageData.h"
#include "vtkObjectFactory.h"

#include <filesystem>

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
  os << indent << "LabelMasks: " << this->LabelMasks << endl;
}

std::string vtkSonoDicomWriter::NamelessRefusal() const
{
  return "No DICOM file is named; set FileName to one that ends in .dcm.";
}

std::string vtkSonoDicomWriter::LabelMaskFileName()
{
  const std::string ending = ".dcm";
  const std::string name = this->GetFileName();
  return name.substr(0, name.size() - (sono::endsWith(name, ending) ? ending.size() : 0)) + ".seg" + ending;
}

void vtkSonoDicomWriter::Open(vtkImageData* image)
{
  const sono::GreySlices greys(image); // the first that may be missing
  sono::CineInfo info;
  const sono::ProbeField probe = sono::readProbe(image->GetFieldData());
  info.probe = probe;
  const sono::GreyLayout layout = sono::greyLayout(image, probe.geometry);
  info.width = layout.width;
  info.height = layout.height;
  info.pixelMm = { layout.pixelMm, layout.pixelMm };
  info.firstMm = layout.firstMm;
  info.patientName = this->PatientName;
  info.patientId = this->PatientId;
  info.timesS = this->TimesS(std::size_t(greys.count()));
  this->Cine = std::make_unique<sono::DicomCine>(this->GetFileName(), info);
  if (this->LabelMasks)
  {
    this->Masks = std::make_unique<sono::DicomMasks>(
      this->LabelMaskFileName(), info, sono::picturePoses(image->GetFieldData(), probe.pose, info.timesS.size()),
      sono::labelTableOf(image->GetFieldData()));
  }
}

void vtkSonoDicomWriter::AddStep(vtkImageData* image)
{
  const sono::GreySlices slices(image);
  for (int n = 0; n < slices.count(); ++n)
  {
    this->Cine->add(slices.at(n), slices.width(), slices.height());
    if (this->Masks)
    {
      this->Masks->add(sono::LabelSlices(image).at(n), slices.width(), slices.height());
    }
    this->Tell(double(n + 1) / slices.count());
  }
}

void vtkSonoDicomWriter::Finish()
{
  if (!this->Masks)
  {
    this->Cine->finish();
    return;
  }
  this->Masks->finish();
  try
  {
    this->Cine->finish();
  }
  catch (const sono::Error&)
  {
    std::error_code ignored;
    std::filesystem::remove(this->LabelMaskFileName(), ignored); // both, or none
    throw;
  }
}

void vtkSonoDicomWriter::Close()
{
  this->Cine.reset();
  this->Masks.reset();
}
