#include "SonoContentKey.h"

#include "Core/Error.h"
#include "Core/FileContent.h"
#include "Core/KeptResults.h"
#include "Core/KeyText.h"
#include "Core/Version.h"
#include "Labels/VoxelFile.h"
#include "vtkSonoLabelMapReader.h"
#include "vtkSonoScanDetail.h"
#include "vtkSonoScanReader.h"

#include "vtkAlgorithm.h"
#include "vtkAlgorithmOutput.h"
#include "vtkExecutive.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationExecutivePortVectorKey.h"
#include "vtkInformationKey.h"
#include "vtkInformationKeyLookup.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <dlfcn.h>
#include <fstream>

namespace sono {
namespace {

using Pipeline = vtkStreamingDemandDrivenPipeline;

/// Of ParaView, behind each output: hands the data on.
bool isPostFilter(vtkAlgorithm* algorithm)
{
  return algorithm->IsA("vtkPVPostFilter") != 0;
}

std::string stampsOf(const std::vector<std::string>& files)
{
  KeyText stamps;
  for (const std::string& file : files)
  {
    const std::string stamp = fileStamp(file);
    if (stamp.empty())
    {
      return {};
    }
    stamps.add(stamp);
  }
  return stamps.text();
}

} // namespace

void ReadFiles::willRead(const std::vector<std::string>& files)
{
  read_ = files;
  readStamps_ = stampsOf(files);
}

std::string ReadFiles::key(const std::vector<std::string>& files)
{
  const std::string stamps = stampsOf(files);
  if (stamps.empty() || (files == read_ && stamps != readStamps_))
  {
    return {};
  }
  if (stamps != hashedStamps_)
  {
    hashedStamps_.clear();
    try
    {
      KeyText text;
      for (const std::string& file : files)
      {
        text.addHash(fileHash(file));
      }
      key_ = text.text();
    }
    catch (const Error&)
    {
      return {}; // whoever reads it says so
    }
    if (stampsOf(files) != stamps)
    {
      return {};
    }
    hashedStamps_ = stamps;
  }
  return key_;
}

bool holdsItsVoxels(const std::string& path)
{
  const std::string ending = voxelFileEnding(path);
  const bool isNrrd = ending == ".nrrd" || ending == ".seg.nrrd";
  if (ending == ".nhdr" || ending == ".mhd")
  {
    return false;
  }
  if (!isNrrd && ending != ".mha")
  {
    return true;
  }
  constexpr std::size_t most = 1 << 16; // of a header
  std::string header(most, '\0');
  std::ifstream stream(path, std::ios::binary);
  stream.read(header.data(), std::streamsize(most));
  header.resize(std::size_t(stream.gcount()));
  if (!isNrrd)
  {
    return header.find("ElementDataFile = LOCAL") != std::string::npos;
  }
  header.resize(std::min(header.find("\n\n"), header.size()));
  return header.find("data file:") == std::string::npos && header.find("datafile:") == std::string::npos;
}

std::string contentKeyOf(vtkAlgorithm* consumer, int port)
{
  const auto producerOf = [](vtkAlgorithm* algorithm, int input) -> vtkAlgorithm* {
    const bool isOne = algorithm->GetNumberOfInputConnections(input) == 1;
    return isOne && algorithm->GetInputConnection(input, 0)->GetIndex() == 0 ? algorithm->GetInputAlgorithm(input, 0)
                                                                             : nullptr;
  };
  vtkAlgorithm* producer = producerOf(consumer, port);
  while (producer && isPostFilter(producer))
  {
    producer = producerOf(producer, 0);
  }
  if (auto* labels = vtkSonoLabelMapReader::SafeDownCast(producer))
  {
    return labels->ContentKey();
  }
  if (auto* scan = vtkSonoScanReader::SafeDownCast(producer))
  {
    return scan->ContentKey();
  }
  auto* added = vtkSonoScanDetail::SafeDownCast(producer);
  return added ? added->ContentKey() : std::string();
}

std::string programKey()
{
  Dl_info self{};
  dladdr(reinterpret_cast<const void*>(&programKey), &self);
  return KeyText().add(version()).add(fileStamp(self.dli_fname ? self.dli_fname : "")).text();
}

std::string fileKey(const std::string& path)
{
  return KeyText().addHash(fileHash(path)).text();
}

std::string keptFolder(const std::string& property)
{
  return property == "auto" ? userCacheFolder() : property;
}

void askNothing(vtkInformation* inInfo)
{
  const int empty[6] = { 0, -1, 0, -1, 0, -1 };
  inInfo->Set(Pipeline::UPDATE_EXTENT(), empty, 6);
}

void giveNothing(vtkInformation* outInfo)
{
  vtkImageData::GetData(outInfo)->Initialize();
  int whole[6];
  outInfo->Get(Pipeline::WHOLE_EXTENT(), whole);
  outInfo->Set(Pipeline::UPDATE_EXTENT(), whole, 6);
}

bool isOutputWanted(vtkAlgorithm* producer, int port)
{
  vtkInformation* outInfo = producer->GetOutputInformation(port);
  // Whoever is connected shares it with the producer.
  const int connected = outInfo->GetReferenceCount() - 1;
  if (isPostFilter(producer))
  {
    return connected > 0;
  }
  // VTK 9.2 never takes one that was deleted off the list: then nobody of it may be asked.
  const int listed = vtkExecutive::CONSUMERS()->Length(outInfo);
  vtkExecutive** consumers = vtkExecutive::CONSUMERS()->GetExecutives(outInfo);
  return listed == 0 || connected < listed || std::any_of(consumers, consumers + listed, [](vtkExecutive* consumer) {
           vtkAlgorithm* algorithm = consumer->GetAlgorithm();
           return !isPostFilter(algorithm) || isOutputWanted(algorithm, 0);
         });
}

void pickNoArrays(vtkAlgorithm* producer)
{
  vtkInformationKey* const picked =
    vtkInformationKeyLookup::Find("POST_ARRAYS_TO_PROCESS", "vtkPVPostFilterExecutive"); // ParaView's
  if (picked && isPostFilter(producer))
  {
    picked->Remove(producer->GetInformation());
  }
}

bool isAskedNothing(vtkInformation* outInfo)
{
  int extent[6] = { 0, 0, 0, 0, 0, 0 };
  if (outInfo->Has(Pipeline::UPDATE_EXTENT()))
  {
    outInfo->Get(Pipeline::UPDATE_EXTENT(), extent);
  }
  return extent[0] > extent[1] || extent[2] > extent[3] || extent[4] > extent[5];
}

bool isInputUpToDate(vtkAlgorithm* consumer, int port)
{
  if (consumer->GetNumberOfInputConnections(port) == 0)
  {
    return true;
  }
  auto* producer = vtkDemandDrivenPipeline::SafeDownCast(consumer->GetInputExecutive(port, 0));
  vtkDataObject* data = consumer->GetInputDataObject(port, 0);
  return producer && data && data->GetUpdateTime() > producer->GetPipelineMTime();
}

} // namespace sono
