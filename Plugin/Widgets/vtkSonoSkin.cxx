#include "vtkSonoSkin.h"

#include "SonoSkinSurface.h"

#include "vtkBoundingBox.h"
#include "vtkBox.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkVector.h"
#include "vtkVectorOperators.h"

#include <algorithm>

vtkStandardNewMacro(vtkSonoSkin);

namespace {

std::vector<vtkPolyData*> meshesOf(vtkDataObject* data)
{
  std::vector<vtkPolyData*> meshes;
  const auto add = [&](vtkDataObject* leaf) {
    vtkPolyData* mesh = vtkPolyData::SafeDownCast(leaf);
    if (mesh && mesh->GetNumberOfPolys() > 0)
    {
      meshes.push_back(mesh);
    }
  };
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    auto leaf = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
    {
      add(leaf->GetCurrentDataObject());
    }
  }
  else
  {
    add(data);
  }
  return meshes;
}

} // namespace

vtkSonoSkin::vtkSonoSkin() = default;
vtkSonoSkin::~vtkSonoSkin() = default;

void vtkSonoSkin::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "SmoothingMm: " << this->SmoothingMm << endl;
  os << indent << "Number of surfaces: " << this->Surfaces.size() << endl;
  os << indent << "NumberOfSorts: " << this->NumberOfSorts << endl;
}

void vtkSonoSkin::SetSurfaces(vtkDataObject* surfaces)
{
  std::vector<std::shared_ptr<SonoSkinSurface>> next;
  for (vtkPolyData* mesh : meshesOf(surfaces))
  {
    const auto known = std::find_if(this->Surfaces.begin(), this->Surfaces.end(),
                                    [&](const auto& surface) { return surface->isMadeOf(mesh); });
    next.push_back(known != this->Surfaces.end() ? *known : std::make_shared<SonoSkinSurface>(mesh));
  }
  this->Surfaces = std::move(next);
}

void vtkSonoSkin::Sort(SonoSkinSurface& surface)
{
  this->NumberOfSorts += surface.sort() ? 1 : 0;
}

void vtkSonoSkin::Prepare()
{
  for (const auto& surface : this->Surfaces)
  {
    this->Sort(*surface);
  }
}

void vtkSonoSkin::GetBounds(double bounds[6]) const
{
  vtkBoundingBox box;
  for (const auto& surface : this->Surfaces)
  {
    box.AddBounds(surface->bounds());
  }
  box.GetBounds(bounds);
}

bool vtkSonoSkin::Meet(const double from[3], const double to[3], double position[3], double normal[3])
{
  const vtkVector3d way = vtkVector3d(to) - vtkVector3d(from);
  // By where the way enters their boxes, the largest first, so that the skin is asked first and what it hides is not
  // asked at all.
  struct Candidate
  {
    double entry;
    double sizeMm;
    SonoSkinSurface* surface;
  };
  std::vector<Candidate> order;
  for (const auto& surface : this->Surfaces)
  {
    double entry[3];
    double t = 0.0;
    if (vtkBox::IntersectBox(surface->bounds(), from, way.GetData(), entry, t) && t <= 1.0)
    {
      order.push_back({ t, vtkBoundingBox(surface->bounds()).GetDiagonalLength(), surface.get() });
    }
  }
  std::sort(order.begin(), order.end(), [](const Candidate& a, const Candidate& b) {
    return a.entry != b.entry ? a.entry < b.entry : a.sizeMm > b.sizeMm;
  });

  double nearest = 2.0;
  SonoSkinSurface* hit = nullptr;
  vtkIdType polygon = -1;
  for (const auto& [entry, size, surface] : order)
  {
    if (entry > nearest)
    {
      break;
    }
    this->Sort(*surface);
    if (surface->meet(vtkVector3d(from), vtkVector3d(to), nearest, position, polygon))
    {
      hit = surface;
    }
  }
  if (!hit)
  {
    return false;
  }
  const vtkVector3d found = hit->normalAt(vtkVector3d(position), polygon, way * -1.0, this->SmoothingMm);
  std::copy(found.GetData(), found.GetData() + 3, normal);
  return true;
}

bool vtkSonoSkin::FindNearest(const double point[3], double position[3], double normal[3])
{
  double least = VTK_DOUBLE_MAX;
  SonoSkinSurface* hit = nullptr;
  vtkIdType polygon = -1;
  for (const auto& surface : this->Surfaces)
  {
    this->Sort(*surface);
    if (surface->findNearest(vtkVector3d(point), least, position, polygon))
    {
      hit = surface.get();
    }
  }
  if (!hit)
  {
    return false;
  }
  const vtkVector3d side = vtkVector3d(point) - vtkVector3d(position);
  const vtkVector3d found = hit->normalAt(vtkVector3d(position), polygon, side, this->SmoothingMm);
  std::copy(found.GetData(), found.GetData() + 3, normal);
  return true;
}
