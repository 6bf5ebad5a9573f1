#include "vtkSonoScanReader.h"

#include "Core/KeyText.h"
#include "Labels/ReadIntensities.h"
#include "Labels/VoxelFile.h"
#include "SonoContentKey.h"
#include "SonoLabelImage.h"
#include "SonoSharedArray.h"
#include "SonoStage.h"

#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkShortArray.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <filesystem>

vtkStandardNewMacro(vtkSonoScanReader);

namespace {

bool isSeries(const std::string& path)
{
  std::error_code error;
  return std::filesystem::is_directory(path, error) || sono::isDicomFile(path);
}

template<class Array, class Value>
void addIntensities(const sono::SharedSpan<Value>& values, vtkImageData* image)
{
  const auto array = sono::sharedArray<Array>("Intensities", values);
  const sono::IntensityRange range = sono::rangeOf(values.begin(), values.size);
  sono::tellRange(range.low, range.high, array);
  image->GetPointData()->SetScalars(array);
}

} // namespace

vtkSonoScanReader::vtkSonoScanReader()
  : Files(std::make_unique<sono::ReadFiles>())
{
  this->SetNumberOfInputPorts(0);
  this->SetProgressText("Reading the scan");
}

vtkSonoScanReader::~vtkSonoScanReader() = default;

void vtkSonoScanReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << endl;
}

/// The file, or all of the series' folder; empty where the voxels lie elsewhere.
std::vector<std::string> vtkSonoScanReader::FilesToRead() const
{
  namespace fs = std::filesystem;
  if (!isSeries(this->FileName))
  {
    return sono::holdsItsVoxels(this->FileName) ? std::vector<std::string>{ this->FileName }
                                                : std::vector<std::string>();
  }
  std::error_code error;
  const fs::path path(this->FileName);
  std::vector<std::string> files{};
  for (const fs::directory_entry& entry :
       fs::directory_iterator(fs::is_directory(path, error) ? path : path.parent_path(), error))
  {
    if (entry.is_regular_file(error))
    {
      files.push_back(entry.path().string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string vtkSonoScanReader::ContentKey()
{
  const std::vector<std::string> files = this->FilesToRead();
  const std::string content = files.empty() ? std::string() : this->Files->key(files);
  if (content.empty())
  {
    return {};
  }
  const std::string name = std::filesystem::path(this->FileName).filename().string(); // of a series, which one
  return sono::KeyText().add("scan").add(content).add(isSeries(this->FileName) ? name : "").text();
}

std::shared_ptr<const sono::IntensityVolume> vtkSonoScanReader::Read()
{
  this->Files->willRead(this->FilesToRead());
  return std::make_shared<const sono::IntensityVolume>(sono::readIntensities(this->FileName, sono::progressOf(this)));
}

int vtkSonoScanReader::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    if (this->FileName.empty())
    {
      throw sono::Error("No scan is named; set FileName to a NIfTI, NRRD or MetaImage file or a DICOM series.");
    }
    this->Series = isSeries(this->FileName) ? this->Read() : nullptr;
    vtkInformation* outInfo = output->GetInformationObject(0);
    if (this->Series)
    {
      sono::announceLabelImage(this->Series->placement, outInfo);
      vtkDataObject::SetPointDataActiveScalarInfo(outInfo, VTK_FLOAT, 1);
    }
    else
    {
      const sono::VoxelFile file = sono::openVoxels(this->FileName);
      sono::announceLabelImage(file.placement, outInfo);
      vtkDataObject::SetPointDataActiveScalarInfo(outInfo, sono::areShorts(file) ? VTK_SHORT : VTK_FLOAT, 1);
    }
  });
}

int vtkSonoScanReader::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    if (sono::isAskedNothing(output->GetInformationObject(0)))
    {
      return sono::giveNothing(output->GetInformationObject(0));
    }
    const std::shared_ptr<const sono::IntensityVolume> volume = this->Series ? this->Series : this->Read();
    vtkImageData* image = vtkImageData::GetData(output);
    sono::placeImage(volume->placement, image);
    if (volume->shorts.data)
    {
      addIntensities<vtkShortArray>(volume->shorts, image);
    }
    else
    {
      const std::shared_ptr<const float> values(volume, volume->values.data());
      addIntensities<vtkFloatArray>(sono::SharedSpan<float>(values, volume->values.size()), image);
    }
    if (!volume->modality.empty())
    {
      vtkNew<vtkStringArray> modality;
      modality->SetName("Modality");
      modality->InsertNextValue(volume->modality);
      image->GetFieldData()->AddArray(modality);
    }
  });
}
