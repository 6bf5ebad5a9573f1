#include "vtkSonoSkin.h"

#include "vtkBoundingBox.h"
#include "vtkBox.h"
#include "vtkCellArray.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStaticCellLocator.h"
#include "vtkVector.h"
#include "vtkVectorOperators.h"

#include <algorithm>
#include <cmath>

vtkStandardNewMacro(vtkSonoSkin);

/// One mesh with its search structure.
class vtkSonoSkin::Surface
{
public:
  explicit Surface(vtkPolyData* source)
    : Points(source->GetPoints())
    , Polygons(source->GetPolys())
    , Time(timeOf(source))
  {
    this->Mesh->ShallowCopy(source);
    this->Mesh->SetVerts(nullptr);
    this->Mesh->SetLines(nullptr);
    this->Mesh->GetBounds(this->Bounds);
  }

  /// A pipeline hands the same arrays on in a new mesh each time it runs.
  bool IsMadeOf(vtkPolyData* source) const
  {
    return this->Points == source->GetPoints() && this->Polygons == source->GetPolys() && this->Time == timeOf(source);
  }

  /// Whether a polygon may touch a box. A coarse answer of one look at each polygon, where the locator sorts them all.
  bool MayTouch(const vtkBoundingBox& box)
  {
    if (this->Marked.empty())
    {
      this->Mark();
    }
    int low[3];
    int high[3];
    this->Range(box, low, high);
    for (int z = low[2]; z <= high[2]; ++z)
    {
      for (int y = low[1]; y <= high[1]; ++y)
      {
        const auto row = this->Marked.begin() + this->Dimensions[0] * (y + this->Dimensions[1] * z);
        if (std::find(row + low[0], row + high[0] + 1, true) != row + high[0] + 1)
        {
          return true;
        }
      }
    }
    return false;
  }

  vtkStaticCellLocator* Locator()
  {
    if (!this->Built)
    {
      this->Mesh->BuildCells();
      this->Finder->SetDataSet(this->Mesh);
      this->Finder->BuildLocator();
      this->Built = true;
    }
    return this->Finder;
  }

  /// Area times normal of a polygon.
  vtkVector3d AreaVector(vtkIdType cell, vtkVector3d& centre)
  {
    const vtkIdType* ids = nullptr;
    vtkIdType count = 0;
    this->Mesh->GetCellPoints(cell, count, ids);
    const auto point = [&](vtkIdType i) {
      vtkVector3d p;
      this->Mesh->GetPoint(ids[i], p.GetData());
      return p;
    };
    const vtkVector3d first = point(0);
    vtkVector3d sum(0.0);
    centre = first;
    for (vtkIdType i = 1; i < count; ++i)
    {
      const vtkVector3d here = point(i);
      centre = centre + here;
      if (i + 1 < count)
      {
        sum = sum + (here - first).Cross(point(i + 1) - first) * 0.5;
      }
    }
    centre = centre * (1.0 / static_cast<double>(count));
    return sum;
  }

  /// The mean normal of the polygons within `radius` that face as `facing`; that itself where there are none.
  vtkVector3d MeanNormal(const vtkVector3d& middle, double radius, double sign, const vtkVector3d& facing)
  {
    double box[6];
    for (int axis = 0; axis < 3; ++axis)
    {
      box[2 * axis] = middle[axis] - radius;
      box[2 * axis + 1] = middle[axis] + radius;
    }
    this->Locator()->FindCellsWithinBounds(box, this->Cells);
    vtkVector3d sum(0.0);
    for (vtkIdType i = 0; i < this->Cells->GetNumberOfIds(); ++i)
    {
      vtkVector3d centre;
      const vtkVector3d area = this->AreaVector(this->Cells->GetId(i), centre) * sign;
      const double share = (centre - middle).SquaredNorm() / (radius * radius);
      if (share < 1.0 && area.Dot(facing) > 0.0)
      {
        sum = sum + area * ((1.0 - share) * (1.0 - share));
      }
    }
    return sum.Norm() > 0.0 ? sum.Normalized() : facing;
  }

  /// The normal at a place on a polygon, on the side that `side` points to.
  vtkVector3d NormalAt(const vtkVector3d& place, vtkIdType cell, const vtkVector3d& side, double radius)
  {
    vtkVector3d centre;
    vtkVector3d facing = this->AreaVector(cell, centre).Normalized();
    // The mesh may be wound inside out.
    const double sign = facing.Dot(side) < 0.0 ? -1.0 : 1.0;
    facing = facing * sign;
    if (radius > 0.0)
    {
      // First a small disc: one triangle of a noisy mesh may face anywhere.
      facing = this->MeanNormal(place, radius / 3.0, sign, facing);
      facing = this->MeanNormal(place, radius, sign, facing);
    }
    return facing;
  }

  double Bounds[6];

private:
  static constexpr double markMm = 8.0;
  static constexpr int mostMarks = 128; // along an axis

  /// The marks that a box covers, within those that there are.
  void Range(const vtkBoundingBox& box, int low[3], int high[3]) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto mark = [&](double at) {
        const double share = (at - this->Bounds[2 * axis]) / this->MarkMm[axis];
        return static_cast<int>(std::clamp(std::floor(share), 0.0, this->Dimensions[axis] - 1.0));
      };
      low[axis] = mark(box.GetMinPoint()[axis]);
      high[axis] = mark(box.GetMaxPoint()[axis]);
    }
  }

  void Mark()
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const double length = this->Bounds[2 * axis + 1] - this->Bounds[2 * axis];
      this->MarkMm[axis] = std::max(markMm, length / mostMarks);
      this->Dimensions[axis] = static_cast<int>(length / this->MarkMm[axis]) + 1;
    }
    this->Marked.assign(std::size_t(this->Dimensions[0]) * this->Dimensions[1] * this->Dimensions[2], false);
    vtkCellArray* polygons = this->Mesh->GetPolys();
    for (vtkIdType cell = 0; cell < polygons->GetNumberOfCells(); ++cell)
    {
      vtkIdType count = 0;
      const vtkIdType* ids = nullptr;
      polygons->GetCellAtId(cell, count, ids, this->Cells);
      vtkBoundingBox box;
      for (vtkIdType i = 0; i < count; ++i)
      {
        double point[3];
        this->Mesh->GetPoint(ids[i], point);
        box.AddPoint(point);
      }
      int low[3];
      int high[3];
      this->Range(box, low, high);
      for (int z = low[2]; z <= high[2]; ++z)
      {
        for (int y = low[1]; y <= high[1]; ++y)
        {
          const auto row = this->Marked.begin() + this->Dimensions[0] * (y + this->Dimensions[1] * z);
          std::fill(row + low[0], row + high[0] + 1, true);
        }
      }
    }
  }

  double MarkMm[3];
  int Dimensions[3];
  std::vector<bool> Marked;
  static vtkMTimeType timeOf(vtkPolyData* mesh)
  {
    return std::max(mesh->GetPoints() ? mesh->GetPoints()->GetMTime() : 0, mesh->GetPolys()->GetMTime());
  }

  vtkSmartPointer<vtkPoints> Points;
  vtkSmartPointer<vtkCellArray> Polygons;
  vtkMTimeType Time;
  vtkNew<vtkPolyData> Mesh;
  vtkNew<vtkStaticCellLocator> Finder;
  vtkNew<vtkIdList> Cells;
  bool Built = false;
};

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
}

void vtkSonoSkin::SetSurfaces(vtkDataObject* surfaces)
{
  std::vector<std::shared_ptr<Surface>> next;
  for (vtkPolyData* mesh : meshesOf(surfaces))
  {
    const auto known = std::find_if(this->Surfaces.begin(), this->Surfaces.end(),
                                    [&](const auto& surface) { return surface->IsMadeOf(mesh); });
    next.push_back(known != this->Surfaces.end() ? *known : std::make_shared<Surface>(mesh));
  }
  this->Surfaces = std::move(next);
}

void vtkSonoSkin::GetBounds(double bounds[6]) const
{
  vtkBoundingBox box;
  for (const auto& surface : this->Surfaces)
  {
    box.AddBounds(surface->Bounds);
  }
  box.GetBounds(bounds);
}

bool vtkSonoSkin::Meet(const double from[3], const double to[3], double position[3], double normal[3])
{
  const vtkVector3d way = vtkVector3d(to) - vtkVector3d(from);
  // By where the way enters their boxes, the largest first, so that the skin is asked first and what it hides is not
  // asked at all: search structures cost more than searching.
  struct Candidate
  {
    double entry;
    double sizeMm;
    Surface* surface;
  };
  std::vector<Candidate> order;
  for (const auto& surface : this->Surfaces)
  {
    double entry[3];
    double t = 0.0;
    if (vtkBox::IntersectBox(surface->Bounds, from, way.GetData(), entry, t) && t <= 1.0)
    {
      order.push_back({ t, vtkBoundingBox(surface->Bounds).GetDiagonalLength(), surface.get() });
    }
  }
  std::sort(order.begin(), order.end(), [](const Candidate& a, const Candidate& b) {
    return a.entry != b.entry ? a.entry < b.entry : a.sizeMm > b.sizeMm;
  });

  double nearest = 2.0;
  Surface* hit = nullptr;
  vtkIdType hitCell = -1;
  vtkNew<vtkGenericCell> scratch;
  for (const auto& [entry, size, surface] : order)
  {
    if (entry > nearest)
    {
      break;
    }
    vtkVector3d start(from);
    vtkVector3d end = start + way * std::min(nearest, 1.0);
    vtkBoundingBox reach;
    reach.AddPoint(start.GetData());
    reach.AddPoint(end.GetData());
    if (!surface->MayTouch(reach))
    {
      continue;
    }
    double t = 0.0;
    double place[3];
    double inCell[3];
    int part = 0;
    vtkIdType cell = -1;
    if (surface->Locator()->IntersectWithLine(from, to, 1e-6, t, place, inCell, part, cell, scratch) && t < nearest)
    {
      nearest = t;
      hit = surface;
      hitCell = cell;
      std::copy(place, place + 3, position);
    }
  }
  if (!hit)
  {
    return false;
  }
  const vtkVector3d found = hit->NormalAt(vtkVector3d(position), hitCell, way * -1.0, this->SmoothingMm);
  std::copy(found.GetData(), found.GetData() + 3, normal);
  return true;
}

bool vtkSonoSkin::FindNearest(const double point[3], double position[3], double normal[3])
{
  double least = VTK_DOUBLE_MAX;
  Surface* hit = nullptr;
  vtkIdType hitCell = -1;
  vtkNew<vtkGenericCell> scratch;
  for (const auto& surface : this->Surfaces)
  {
    double place[3];
    vtkIdType cell = -1;
    int part = 0;
    double distance2 = 0.0;
    surface->Locator()->FindClosestPoint(point, place, scratch, cell, part, distance2);
    if (cell >= 0 && distance2 < least)
    {
      least = distance2;
      hit = surface.get();
      hitCell = cell;
      std::copy(place, place + 3, position);
    }
  }
  if (!hit)
  {
    return false;
  }
  const vtkVector3d side = vtkVector3d(point) - vtkVector3d(position);
  const vtkVector3d found = hit->NormalAt(vtkVector3d(position), hitCell, side, this->SmoothingMm);
  std::copy(found.GetData(), found.GetData() + 3, normal);
  return true;
}
