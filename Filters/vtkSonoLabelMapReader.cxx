#include "vtkSonoLabelMapReader.h"

#include "Labels/LabelTable.h"
#include "Labels/ReadLabelMap.h"
#include "SonoLabelImage.h"
#include "SonoStage.h"

#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkXMLImageDataReader.h"

#include <vtksys/SystemTools.hxx>

vtkStandardNewMacro(vtkSonoLabelMapReader);

namespace {

bool endsWith(const std::string& fileName, const char* ending)
{
  return vtksys::SystemTools::StringEndsWith(vtksys::SystemTools::LowerCase(fileName), ending);
}

/// Names that the image itself lacks come from a table beside the file.
void nameLabels(const std::string& fileName, vtkImageData* image, sono::LabelVolume& volume)
{
  const std::string stem = fileName.substr(0, fileName.size() - std::string(".vti").size());
  const std::string table =
    image->GetFieldData()->HasArray("LabelNames") ? std::string() : sono::labelTableBeside(stem);
  if (!table.empty())
  {
    sono::readLabelTable(table, volume);
  }
}

sono::LabelVolume readVti(const std::string& fileName)
{
  vtkNew<vtkXMLImageDataReader> reader;
  if (!vtksys::SystemTools::FileExists(fileName, true) || !reader->CanReadFile(fileName.c_str()))
  {
    throw sono::Error("The file " + fileName + " is missing or no VTK image; name a label map that can be read.");
  }
  reader->SetFileName(fileName.c_str());
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  sono::LabelVolume volume;
  try
  {
    volume = sono::labelVolumeFromImage(image, image->GetPointData()->GetScalars());
  }
  catch (const sono::Error& error)
  {
    throw sono::Error(fileName + ": " + error.what());
  }
  nameLabels(fileName, image, volume);
  return volume;
}

std::shared_ptr<const sono::LabelVolume> readVolume(const std::string& fileName)
{
  if (fileName.empty())
  {
    throw sono::Error("No label map is named; set FileName to a .nii, .nii.gz, .nrrd, .mha, .mhd or .vti file.");
  }
  if (endsWith(fileName, ".vti"))
  {
    return std::make_shared<const sono::LabelVolume>(readVti(fileName));
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
  for (const char* ending : { ".nii", ".nii.gz", ".nrrd", ".nhdr", ".mha", ".mhd", ".vti" })
  {
    if (fileName && endsWith(fileName, ending))
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
