#include "vtkSonoSceneHandle.h"

#include "Core/Progress.h"
#include "Scene/Scene.h"

#include "vtkFieldData.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"

#include <algorithm>
#include <sstream>

vtkStandardNewMacro(vtkSonoSceneHandle);

namespace {

constexpr const char* sceneHandleName = "SonoScene";

std::string summary(const sono::Scene& scene)
{
  const sono::Vec3i size = scene.placement().size;
  std::ostringstream text;
  text << size.x << " x " << size.y << " x " << size.z << " voxels, " << scene.volume().labels.size() << " labels, "
       << scene.tissues().size() << " tissues";
  return text.str();
}

} // namespace

vtkSonoSceneHandle::vtkSonoSceneHandle() = default;
vtkSonoSceneHandle::~vtkSonoSceneHandle() = default;

void vtkSonoSceneHandle::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Scene: " << (this->Scene ? summary(*this->Scene) : "none") << endl;
  os << indent << "Prepared for a moving probe: " << (this->Scene && this->Scene->hasInteractiveRegion() ? "yes" : "no")
     << endl;
}

void vtkSonoSceneHandle::Attach(std::shared_ptr<const sono::Scene> scene,
                                std::shared_ptr<const sono::TissueTable> tissues, vtkMultiBlockDataSet* blocks)
{
  vtkNew<vtkSonoSceneHandle> handle;
  handle->SetName(sceneHandleName);
  handle->InsertNextValue(summary(*scene));
  handle->Scene = std::move(scene);
  handle->Tissues = std::move(tissues);
  blocks->GetBounds(handle->Bounds);
  blocks->GetFieldData()->AddArray(handle);
}

std::shared_ptr<const sono::Scene> vtkSonoSceneHandle::Get(vtkMultiBlockDataSet* blocks)
{
  vtkSonoSceneHandle* handle = blocks ? Find(blocks->GetFieldData()) : nullptr;
  if (!handle)
  {
    throw sono::Error("The input carries no ultrasound scene; connect the output of an Ultrasound Scene.");
  }
  double bounds[6];
  blocks->GetBounds(bounds);
  if (!std::equal(bounds, bounds + 6, handle->Bounds))
  {
    throw sono::Error("The label surfaces were moved or cut after the Ultrasound Scene was built, so they no longer "
                      "show its anatomy; connect the Ultrasound Scene itself.");
  }
  return handle->Scene;
}

std::shared_ptr<const sono::Scene> vtkSonoSceneHandle::Get(vtkFieldData* field)
{
  return Need(field)->Scene;
}

std::shared_ptr<const sono::TissueTable> vtkSonoSceneHandle::GetTissues(vtkFieldData* field)
{
  return Need(field)->Tissues;
}

void vtkSonoSceneHandle::DeepCopy(vtkAbstractArray* other)
{
  this->Superclass::DeepCopy(other);
  if (auto* handle = vtkSonoSceneHandle::SafeDownCast(other))
  {
    this->Scene = handle->Scene;
    this->Tissues = handle->Tissues;
    std::copy(handle->Bounds, handle->Bounds + 6, this->Bounds);
  }
}

vtkSonoSceneHandle* vtkSonoSceneHandle::Need(vtkFieldData* field)
{
  vtkSonoSceneHandle* handle = Find(field);
  if (!handle)
  {
    throw sono::Error("The input carries no ultrasound scene, which files do not keep; connect the output of an "
                      "Ultrasound Ray Tracer.");
  }
  return handle;
}

vtkSonoSceneHandle* vtkSonoSceneHandle::Find(vtkFieldData* field)
{
  auto* handle = field ? vtkSonoSceneHandle::SafeDownCast(field->GetAbstractArray(sceneHandleName)) : nullptr;
  return handle && handle->Scene ? handle : nullptr;
}
