#include "SonoSharedAnatomy.h"

#include "Core/KeyText.h"
#include "Scene/Scene.h"
#include "SonoContent.h"
#include "SonoDisplay.h"
#include "SonoPlayed.h"

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <mutex>

namespace sono {
namespace {

struct Shared
{
  std::string content;
  std::string settings;
  std::weak_ptr<const Scene> scene;
  std::shared_ptr<const TissueTable> tissues;
  std::vector<std::string> warnings;
};

struct AllShared
{
  std::mutex mutex;
  std::vector<Shared> anatomies;
};

AllShared& all()
{
  static AllShared shared;
  return shared;
}

void addArray(vtkAbstractArray* array, KeyText& key)
{
  key.add(array->GetName() ? array->GetName() : "").add(double(array->GetNumberOfComponents()));
  key.add(double(array->GetDataType()));
  const auto* numbers = vtkDataArray::SafeDownCast(array);
  if (numbers && numbers->HasStandardMemoryLayout())
  {
    const std::size_t bytes = std::size_t(array->GetNumberOfValues()) * std::size_t(array->GetDataTypeSize());
    key.addHash(hash64(array->GetVoidPointer(0), bytes));
    return;
  }
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
  {
    key.add(std::string_view(array->GetVariantValue(i).ToString()));
  }
}

/// By value: a reader that reads a phase again makes new arrays of the same numbers.
std::string contentWith(vtkDataArray* labels, vtkImageData* image)
{
  KeyText key;
  const auto add = [&key](const double* numbers, int count) {
    std::for_each(numbers, numbers + count, [&key](double number) { key.add(number); });
  };
  for (vtkFieldData* arrays : { image->GetFieldData(), static_cast<vtkFieldData*>(image->GetPointData()) })
  {
    key.add(double(arrays->GetNumberOfArrays()));
    for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
    {
      addArray(arrays->GetAbstractArray(i), key);
    }
  }
  for (int edge : std::vector<int>(image->GetExtent(), image->GetExtent() + 6))
  {
    key.add(double(edge));
  }
  add(image->GetOrigin(), 3);
  add(image->GetSpacing(), 3);
  add(image->GetDirectionMatrix()->GetData(), 9);
  key.add(labels && labels->GetName() ? labels->GetName() : "");
  return key.text();
}

/// What a phase's scene takes, no less: labels, tissues and detail (5 bytes a voxel), the tracer's region and that of a
/// moving probe (3 each), label grid, surfaces and smooth pieces (5), and the motion of its tissue.
std::size_t bytesOf(const Scene& scene)
{
  constexpr std::size_t ofVoxel = 16;
  constexpr std::size_t ofMotion = 12;
  return scene.placement().voxelCount() * (scene.motion() ? ofVoxel + ofMotion : ofVoxel);
}

std::string sceneKey(const Scene& scene, const std::string& what)
{
  return what + " " + std::to_string(scene.id());
}

} // namespace

std::optional<SharedAnatomy> findAnatomy(vtkImageData* image, vtkDataArray* labels, const std::string& settings)
{
  const std::string content = contentWith(labels, image);
  const std::lock_guard<std::mutex> lock(all().mutex);
  for (const Shared& shared : all().anatomies)
  {
    if (shared.content == content && shared.settings == settings)
    {
      if (const auto scene = shared.scene.lock())
      {
        findPlayed(sceneKey(*scene, "scene")); // it is used
        return SharedAnatomy{ scene, shared.tissues, shared.warnings };
      }
    }
  }
  return std::nullopt;
}

void shareAnatomy(vtkImageData* image, vtkDataArray* labels, const std::string& settings, const SharedAnatomy& anatomy,
                  const void* owner)
{
  const std::string content = contentWith(labels, image);
  const std::lock_guard<std::mutex> lock(all().mutex);
  std::vector<Shared>& anatomies = all().anatomies;
  anatomies.erase(
    std::remove_if(anatomies.begin(), anatomies.end(), [](const Shared& shared) { return shared.scene.expired(); }),
    anatomies.end());
  anatomies.push_back({ content, settings, anatomy.scene, anatomy.tissues, anatomy.warnings });
  if (timeOf(image))
  {
    keepPlayed(owner, sceneKey(*anatomy.scene, "scene"), anatomy.scene, bytesOf(*anatomy.scene));
  }
}

bool takePlayedBlocks(const Scene& scene, bool surfaces, vtkMultiBlockDataSet* blocks)
{
  const auto kept = std::static_pointer_cast<const vtkSmartPointer<vtkMultiBlockDataSet>>(
    findPlayed(sceneKey(scene, surfaces ? "surfaces" : "outline")));
  if (kept)
  {
    blocks->ShallowCopy(*kept);
  }
  return kept != nullptr;
}

void keepPlayedBlocks(vtkImageData* image, const Scene& scene, bool surfaces, vtkMultiBlockDataSet* blocks,
                      const void* owner)
{
  if (timeOf(image))
  {
    const auto copy =
      std::make_shared<vtkSmartPointer<vtkMultiBlockDataSet>>(vtk::TakeSmartPointer(blocks->NewInstance()));
    (*copy)->ShallowCopy(blocks);
    keepPlayed(owner, sceneKey(scene, surfaces ? "surfaces" : "outline"), copy,
               1024 * std::size_t(blocks->GetActualMemorySize()));
  }
}

} // namespace sono
