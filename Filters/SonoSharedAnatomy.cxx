#include "SonoSharedAnatomy.h"

#include "Scene/Scene.h"
#include "SonoContent.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"

#include <algorithm>
#include <mutex>

namespace sono {
namespace {

struct Shared
{
  std::vector<double> content;
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

std::vector<double> contentWith(vtkDataArray* labels, vtkImageData* image)
{
  std::vector<double> content = contentOf(image);
  content.push_back(labels ? double(labels->GetMTime()) : 0.0);
  return content;
}

} // namespace

std::optional<SharedAnatomy> findAnatomy(vtkImageData* image, vtkDataArray* labels, const std::string& settings)
{
  const std::vector<double> content = contentWith(labels, image);
  const std::lock_guard<std::mutex> lock(all().mutex);
  for (const Shared& shared : all().anatomies)
  {
    if (shared.content == content && shared.settings == settings)
    {
      if (const auto scene = shared.scene.lock())
      {
        return SharedAnatomy{ scene, shared.tissues, shared.warnings };
      }
    }
  }
  return std::nullopt;
}

void shareAnatomy(vtkImageData* image, vtkDataArray* labels, const std::string& settings, const SharedAnatomy& anatomy)
{
  const std::vector<double> content = contentWith(labels, image);
  const std::lock_guard<std::mutex> lock(all().mutex);
  std::vector<Shared>& anatomies = all().anatomies;
  anatomies.erase(
    std::remove_if(anatomies.begin(), anatomies.end(), [](const Shared& shared) { return shared.scene.expired(); }),
    anatomies.end());
  anatomies.push_back({ content, settings, anatomy.scene, anatomy.tissues, anatomy.warnings });
}

} // namespace sono
