#include "vtkSonoLabelMapReader.h"

#include "Labels/ReadLabelMap.h"
#include "SonoLabelImage.h"
#include "SonoStage.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"

#include <vtksys/SystemTools.hxx>

vtkStandardNewMacro(vtkSonoLabelMapReader);

namespace {

std::shared_ptr<const sono::LabelVolume> readVolume(const std::string& fileName)
{
  if (fileName.empty())
  {
    throw sono::Error("No label map is named; set FileName to a .nii, .nii.gz, .nrrd or .seg.nrrd file.");
  }
  return std::make_shared<const sono::LabelVolume>(sono::readLabelMap(fileName));
}

} // namespace

vtkSonoLabelMapReader::vtkSonoLabelMapReader()
{
  this->SetNumberOfInputPorts(0);
}

vtkSonoLabelMapReader::~vtkSonoLabelMapReader() = default;

void vtkSonoLabelMapReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << endl;
}

int vtkSonoLabelMapReader::CanReadFile(const char* fileName)
{
  const std::string name = fileName ? vtksys::SystemTools::LowerCase(fileName) : "";
  for (const char* ending : { ".nii", ".nii.gz", ".nrrd" })
  {
    if (vtksys::SystemTools::StringEndsWith(name, ending))
    {
      return 1;
    }
  }
  return 0;
}

int vtkSonoLabelMapReader::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    this->Volume = readVolume(this->FileName);
    sono::announceLabelImage(this->Volume->placement, output->GetInformationObject(0));
  });
}

int vtkSonoLabelMapReader::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    const auto volume = this->Volume ? std::move(this->Volume) : readVolume(this->FileName);
    sono::imageFromLabelVolume(*volume, vtkImageData::GetData(output));
  });
}
