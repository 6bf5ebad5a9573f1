#include "vtkSonoDataSet.h"

#include "Core/FileContent.h"
#include "DataSets/DataSetImager.h"
#include "DataSets/ImageStream.h"
#include "DataSets/WriteDataSet.h"
#include "Image/ScanConvert.h"
#include "SonoDataFile.h"
#include "SonoLabelImage.h"
#include "SonoPicture.h"
#include "SonoStage.h"
#include "vtkSonoGpuImage.h"

#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

vtkStandardNewMacro(vtkSonoDataSet);

namespace {

void addBytes(const char* name, const std::vector<std::uint8_t>& bytes, vtkImageData* image)
{
  vtkNew<vtkUnsignedCharArray> array;
  array->SetName(name);
  array->SetNumberOfValues(static_cast<vtkIdType>(bytes.size()));
  std::copy(bytes.begin(), bytes.end(), array->GetPointer(0));
  image->GetPointData()->AddArray(array);
}

void addFloats(const char* name, const std::vector<float>& values, vtkImageData* image)
{
  vtkNew<vtkFloatArray> array;
  array->SetName(name);
  array->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  image->GetPointData()->AddArray(array);
}

void addTexts(const char* name, const std::vector<std::string>& texts, vtkFieldData* field)
{
  vtkNew<vtkStringArray> array;
  array->SetName(name);
  for (const std::string& text : texts)
  {
    array->InsertNextValue(text);
  }
  field->AddArray(array);
}

std::string progressText(const sono::DataSetTally& tally)
{
  char words[96];
  std::snprintf(words, sizeof(words), "Data set: image %lld of %lld, %.1f images/s", (long long)tally.done,
                (long long)tally.total, tally.seconds > 0.0 ? double(tally.made) / tally.seconds : 0.0);
  return words;
}

} // namespace

vtkSonoDataSet::vtkSonoDataSet()
{
  this->SetNumberOfInputPorts(0);
  this->SetProgressText("Data set");
}

vtkSonoDataSet::~vtkSonoDataSet() = default;

void vtkSonoDataSet::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << endl;
  os << indent << "Folder: " << this->Folder << endl;
  os << indent << "ImageNumber: " << this->ImageNumber << endl;
  os << indent << "Part: " << this->Part << endl;
  os << indent << "Parts: " << this->Parts << endl;
  os << indent << "KeepsOnGpu: " << this->KeepsOnGpu << endl;
  os << indent << "WrittenImages: " << this->WrittenImages << endl;
  os << indent << "ImagesPerSecond: " << this->ImagesPerSecond << endl;
}

std::shared_ptr<const sono::DataSetPlan> vtkSonoDataSet::ReadPlan()
{
  const std::string bundled = sono::dataFileCalled(this->FileName, "datasets", ".json");
  const std::string path = bundled.empty() ? sono::chosenOrBundled(this->FileName, "datasets/apical.json") : bundled;
  const std::string stamp = path + sono::fileStamp(path);
  if (!this->Plan || stamp != this->Stamp)
  {
    const std::string dataFolder = std::filesystem::path(sono::dataFile("tissues.csv")).parent_path().string();
    this->EndStream();
    this->Imager = nullptr;
    this->Plan = nullptr;
    this->Plan = std::make_shared<const sono::DataSetPlan>(sono::readDataSet(path, dataFolder));
    this->Imager = std::make_unique<sono::DataSetImager>(this->Plan);
    if (this->KeepsOnGpu)
    {
      this->Imager->keepOnGpu();
    }
    this->Stamp = stamp;
  }
  return this->Plan;
}

sono::DataSetShare vtkSonoDataSet::GetShare() const
{
  if (this->Parts > 0)
  {
    return { this->Part, this->Parts };
  }
  vtkMultiProcessController* processes = vtkMultiProcessController::GetGlobalController();
  return processes ? sono::DataSetShare{ processes->GetLocalProcessId(), processes->GetNumberOfProcesses() }
                   : sono::DataSetShare{};
}

vtkIdType vtkSonoDataSet::GetNumberOfImages()
{
  vtkIdType count = 0;
  sono::runWork(this, [&] { count = this->ReadPlan()->imageCount(); });
  return count;
}

vtkIdType vtkSonoDataSet::GetFirstImage()
{
  vtkIdType first = 0;
  sono::runWork(this, [&] { first = this->ReadPlan()->imagesOf(this->GetShare()).first; });
  return first;
}

vtkIdType vtkSonoDataSet::GetEndImage()
{
  vtkIdType end = 0;
  sono::runWork(this, [&] { end = this->ReadPlan()->imagesOf(this->GetShare()).end; });
  return end;
}

std::string vtkSonoDataSet::GetSplit(vtkIdType image)
{
  std::string split;
  sono::runWork(this, [&] {
    const auto plan = this->ReadPlan();
    plan->requireImage(image);
    split = sono::nameOf(plan->splitOf(image));
  });
  return split;
}

bool vtkSonoDataSet::BeginStream(const std::string& split)
{
  return sono::runWork(this, [&] {
    const auto plan = this->ReadPlan();
    this->EndStream();
    const sono::ImageStream::Wanted isOfSplit = [plan, split](std::int64_t image) {
      return split == sono::nameOf(plan->splitOf(image));
    };
    this->Stream = std::make_unique<sono::ImageStream>(*this->Imager, this->GetShare(),
                                                       split.empty() ? sono::ImageStream::Wanted() : isOfSplit);
  });
}

int vtkSonoDataSet::TakeImage()
{
  int found = NO_IMAGE_LEFT;
  sono::runWork(this, [&] {
    if (!this->Stream)
    {
      return;
    }
    std::optional<sono::StreamedImage> taken = this->Stream->takeMade();
    if (!taken)
    {
      found = this->Stream->hasEnded() ? NO_IMAGE_LEFT : IMAGE_AWAITED;
      return;
    }
    this->ReadPlan(); // not each time that somebody asks in vain; it ends the stream where the file has changed
    if (!this->Stream)
    {
      return;
    }
    this->ImageNumber = int(taken->index);
    this->Taken = std::make_unique<sono::StreamedImage>(std::move(*taken));
    this->Modified();
    found = IMAGE_TAKEN;
  });
  return found;
}

void vtkSonoDataSet::EndStream()
{
  this->Stream = nullptr;
  this->Taken = nullptr;
}

bool vtkSonoDataSet::KeepOnGpu()
{
  return sono::runWork(this, [&] {
    this->ReadPlan();
    this->Imager->keepOnGpu();
    this->KeepsOnGpu = true;
    this->Modified();
  });
}

vtkSonoGpuImage* vtkSonoDataSet::GetGpuImage()
{
  return this->GpuImage;
}

int vtkSonoDataSet::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    const auto plan = this->ReadPlan();
    plan->requireImage(this->ImageNumber);
    const sono::PlaneImage layout = plan->layout(plan->image(this->ImageNumber));
    vtkInformation* outInfo = output->GetInformationObject(0);
    const int extent[6] = { 0, layout.width - 1, 0, layout.height - 1, 0, 0 };
    const double origin[3] = { layout.lateralMinMm, layout.axialMinMm, 0.0 };
    const double spacing[3] = { layout.pixelMm, layout.pixelMm, 1.0 };
    outInfo->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
    outInfo->Set(vtkDataObject::ORIGIN(), origin, 3);
    outInfo->Set(vtkDataObject::SPACING(), spacing, 3);
    vtkDataObject::SetPointDataActiveScalarInfo(outInfo, VTK_UNSIGNED_CHAR, 1);
    outInfo->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1); // or only the first process would be asked to work
  });
}

void vtkSonoDataSet::WriteFolder()
{
  this->WrittenImages = 0;
  this->ImagesPerSecond = 0.0;
  if (!this->Folder.empty())
  {
    const auto tell = [this](const sono::DataSetTally& tally) {
      this->WrittenImages = tally.made;
      this->ImagesPerSecond = tally.seconds > 0.0 ? double(tally.made) / tally.seconds : 0.0;
      this->SetProgressText(progressText(tally).c_str());
    };
    sono::writeDataSet(*this->Imager, this->Folder, this->GetShare(), sono::progressOf(this), tell, 0,
                       sono::openExrBytes);
  }
}

void vtkSonoDataSet::GiveImage(vtkImageData* image)
{
  const bool isTaken = this->Taken && this->Taken->index == this->ImageNumber;
  const sono::DataSetImage made =
    isTaken ? std::move(this->Taken->image) : this->Imager->make(this->ImageNumber, sono::progressOf(this));
  this->Taken = nullptr;
  this->GpuImage.TakeReference(vtkSonoGpuImage::NewFrom(made));
  image->Initialize();
  image->SetDimensions(made.width, made.height, 1);
  image->SetOrigin(made.lateralMinMm, made.axialMinMm, 0.0);
  image->SetSpacing(made.pixelMm, made.pixelMm, 1.0);
  addBytes("BMode", made.grey, image);
  addBytes("Mask", made.mask, image);
  for (std::size_t channel = 0; channel < made.channels.names.size(); ++channel)
  {
    addFloats(made.channels.names[channel].c_str(), made.channels.values[channel], image);
  }
  image->GetPointData()->SetActiveScalars("BMode");
  addTexts("Info", { made.info }, image->GetFieldData());
  addTexts("MaskGroups", made.groups, image->GetFieldData());
}

int vtkSonoDataSet::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  vtkMultiProcessController* processes = vtkMultiProcessController::GetGlobalController();
  if (processes && processes->GetLocalProcessId() > 0) // whose output stays empty
  {
    sono::runWork(this, [&] {
      this->ReadPlan();
      this->WriteFolder();
    });
    return 1;
  }
  return sono::runStage(this, output, [&] {
    this->ReadPlan();
    this->WriteFolder();
    this->GiveImage(vtkImageData::GetData(output));
  });
}
