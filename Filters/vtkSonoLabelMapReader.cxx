#include "vtkSonoLabelMapReader.h"

#include "Core/EndsWith.h"
#include "Core/KeyText.h"
#include "Labels/KnownNumbers.h"
#include "Labels/LabelTable.h"
#include "Labels/ReadDicomSeg.h"
#include "Labels/ReadLabelMap.h"
#include "Labels/VoxelFile.h"
#include "SonoContentKey.h"
#include "SonoDataFile.h"
#include "SonoLabelImage.h"
#include "SonoPlayed.h"
#include "SonoStage.h"
#include "SonoVtkImageFile.h"

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <filesystem>
#include <utility>

vtkStandardNewMacro(vtkSonoLabelMapReader);

namespace {

using Pipeline = vtkStreamingDemandDrivenPipeline;

bool hasEnding(const std::string& fileName, const char* ending)
{
  return sono::endsWith(vtksys::SystemTools::LowerCase(fileName), ending);
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
  sono::nameKnownNumbers(volume);
}

sono::LabelVolume readVti(const std::string& fileName, vtkImageData* image)
{
  sono::readVtkImage(fileName, image);
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

void passMotion(vtkImageData* from, vtkImageData* to)
{
  if (vtkDataArray* displacement = from->GetPointData()->GetArray(sono::displacementArray))
  {
    to->GetPointData()->AddArray(displacement);
  }
  if (vtkDataArray* labels = from->GetFieldData()->GetArray(sono::movingLabelsArray))
  {
    to->GetFieldData()->AddArray(labels);
  }
}

/// The bundled list of this name: "CT-ORG" is label_lists/ct_org.csv.
std::string listOfNames(const std::string& name)
{
  const std::string file = sono::dataFileCalled(name, "label_lists", ".csv");
  if (file.empty())
  {
    throw sono::Error("There is no list of label names '" + name +
                      "'; set LabelNames to From File, TotalSegmentator v2 or "
                      "another of those that the panel offers.");
  }
  return file;
}

bool isVti(const std::string& fileName)
{
  return hasEnding(fileName, ".vti");
}

/// When each phase is: of one file as the file says, of several 0, 1, 2, ...
std::vector<double> timesOf(const std::vector<std::string>& fileNames)
{
  if (fileNames.empty())
  {
    throw sono::Error("No label map is named; set FileName to a .nii, .nii.gz, .nrrd, .mha, .mhd, .dcm or .vti file.");
  }
  const bool isOne = fileNames.size() == 1;
  const sono::LabelPhases phases =
    isOne && !isVti(fileNames[0]) ? sono::readLabelPhases(fileNames[0]) : sono::LabelPhases();
  std::vector<double> times(isOne ? std::size_t(phases.count) : fileNames.size());
  for (std::size_t i = 0; i < times.size(); ++i)
  {
    times[i] = double(i) * phases.stepS;
  }
  return times;
}

} // namespace

vtkSonoLabelMapReader::vtkSonoLabelMapReader()
  : Files(std::make_unique<sono::ReadFiles>())
{
  this->SetNumberOfInputPorts(0);
  this->SetProgressText("Reading the label map");
}

vtkSonoLabelMapReader::~vtkSonoLabelMapReader()
{
  sono::dropPlayed(this);
}

void vtkSonoLabelMapReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileNames:";
  for (const std::string& fileName : this->FileNames)
  {
    os << " " << fileName;
  }
  os << endl;
  os << indent << "LabelNames: " << this->LabelNames << endl;
}

void vtkSonoLabelMapReader::SetFileName(const char* fileName)
{
  if (this->FileNames.size() != 1 || !fileName || this->FileNames[0] != fileName)
  {
    this->RemoveAllFileNames();
    this->AddFileName(fileName);
  }
}

void vtkSonoLabelMapReader::AddFileName(const char* fileName)
{
  if (fileName && *fileName)
  {
    this->FileNames.emplace_back(fileName);
    this->Modified();
  }
}

void vtkSonoLabelMapReader::RemoveAllFileNames()
{
  if (!this->FileNames.empty())
  {
    this->FileNames.clear();
    this->Modified();
  }
}

/// All that the output depends on; empty where that is not known.
std::vector<std::string> vtkSonoLabelMapReader::FilesToRead() const
{
  namespace fs = std::filesystem;
  if (this->FileNames.size() != 1 || this->Times.size() != 1)
  {
    return {};
  }
  const std::string& path = this->FileNames[0];
  std::vector<std::string> files{ path };
  std::error_code error;
  if (fs::is_directory(path, error))
  {
    files.clear();
    for (const fs::directory_entry& entry : fs::directory_iterator(path, error))
    {
      if (!sono::voxelFileEnding(entry.path().string()).empty())
      {
        files.push_back(entry.path().string());
      }
    }
    std::sort(files.begin(), files.end());
  }
  else
  {
    const std::string ending = sono::voxelFileEnding(path);
    const std::string table = sono::labelTableBeside(ending.empty() ? fs::path(path).replace_extension().string()
                                                                    : path.substr(0, path.size() - ending.size()));
    if (!table.empty())
    {
      files.push_back(table);
    }
  }
  if (this->LabelNames != "From File")
  {
    files.push_back(listOfNames(this->LabelNames));
  }
  return std::all_of(files.begin(), files.end(), sono::holdsItsVoxels) ? files : std::vector<std::string>();
}

std::string vtkSonoLabelMapReader::ContentKey()
{
  try
  {
    const std::vector<std::string> files = this->FilesToRead();
    const std::string content = files.empty() || !this->Noticed.empty() ? std::string() : this->Files->key(files);
    if (content.empty())
    {
      return {};
    }
    sono::KeyText key;
    key.add("label map").add(content).add(this->LabelNames);
    for (const std::string& file : files)
    {
      key.add(std::filesystem::path(file).filename().string()); // masks are named by it
    }
    return key.text();
  }
  catch (const sono::Error&)
  {
    return {}; // said when it is read
  }
}

sono::LabelVolume vtkSonoLabelMapReader::ReadPhase(int phase, vtkImageData* vti)
{
  const bool isOne = this->FileNames.size() == 1;
  const std::string& fileName = this->FileNames[isOne ? 0 : std::size_t(phase)];
  sono::LabelVolume volume =
    isVti(fileName) ? readVti(fileName, vti) : sono::readLabelMap(fileName, isOne ? phase : 0, sono::progressOf(this));
  if (this->LabelNames != "From File")
  {
    sono::readLabelTable(listOfNames(this->LabelNames), volume);
  }
  if (!volume.notice.empty() && this->Noticed.insert(volume.notice).second)
  {
    sono::warn(this, volume.notice);
  }
  return volume;
}

int vtkSonoLabelMapReader::CanReadFile(const char* fileName)
{
  for (const char* ending : { ".nii", ".nii.gz", ".nrrd", ".nhdr", ".mha", ".mhd", ".vti" })
  {
    if (fileName && hasEnding(fileName, ending))
    {
      return 1;
    }
  }
  return fileName && hasEnding(fileName, ".dcm") && sono::isDicomSeg(fileName) ? 1 : 0;
}

int vtkSonoLabelMapReader::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    sono::dropPlayed(this); // other files, or they are to be read again
    this->Times = timesOf(this->FileNames);
    vtkInformation* outInfo = output->GetInformationObject(0);
    const std::string& first = this->FileNames[0];
    vtkNew<vtkImageData> vti;
    sono::announceLabelImage(isVti(first) ? readVti(first, vti).placement : sono::readLabelPlacement(first), outInfo);
    outInfo->Remove(Pipeline::TIME_STEPS());
    outInfo->Remove(Pipeline::TIME_RANGE());
    if (this->Times.size() > 1)
    {
      const double range[2] = { this->Times.front(), this->Times.back() };
      outInfo->Set(Pipeline::TIME_STEPS(), this->Times.data(), static_cast<int>(this->Times.size()));
      outInfo->Set(Pipeline::TIME_RANGE(), range, 2);
    }
  });
}

int vtkSonoLabelMapReader::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    vtkInformation* outInfo = output->GetInformationObject(0);
    if (sono::isAskedNothing(outInfo))
    {
      return sono::giveNothing(outInfo);
    }
    this->Files->willRead(this->FilesToRead());
    const double time =
      outInfo->Has(Pipeline::UPDATE_TIME_STEP()) ? outInfo->Get(Pipeline::UPDATE_TIME_STEP()) : this->Times.front();
    // The last phase that has begun.
    const auto after = std::upper_bound(this->Times.begin(), this->Times.end(), time + 1e-9);
    const int phase = std::max(0, static_cast<int>(after - this->Times.begin()) - 1);

    vtkImageData* image = vtkImageData::GetData(output);
    if (this->Times.size() > 1 && sono::takePlayedPhase(this, phase, image))
    {
      image->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), this->Times[std::size_t(phase)]);
      return;
    }
    vtkNew<vtkImageData> vti;
    sono::LabelVolume volume = this->ReadPhase(phase, vti);
    int announced[6];
    outInfo->Get(Pipeline::WHOLE_EXTENT(), announced);
    sono::imageFromLabelVolume(std::move(volume), image);
    if (!std::equal(announced, announced + 6, image->GetExtent()))
    {
      const std::string name = this->FileNames[this->FileNames.size() == 1 ? 0 : std::size_t(phase)];
      image->Initialize();
      throw sono::Error("The label map " + name +
                        " has another number of voxels than the first one; resample it to the same grid.");
    }
    passMotion(vti, image);
    if (this->Times.size() > 1)
    {
      image->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), this->Times[std::size_t(phase)]);
      sono::keepPlayedPhase(this, phase, image);
    }
  });
}
