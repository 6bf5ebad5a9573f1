#include "SonoSkinSurface.h"

#include "vtkCellArray.h"
#include "vtkFloatArray.h"
#include "vtkPoints.h"
#include "vtkVectorOperators.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace {

constexpr double cubeMm = 5.0;
constexpr int mostCubes = 128; // along an axis

vtkMTimeType timeOf(vtkPolyData* mesh)
{
  return std::max(mesh->GetPoints() ? mesh->GetPoints()->GetMTime() : 0, mesh->GetPolys()->GetMTime());
}

/// The middles of all polygons as (x, y, z), and the farthest that a corner lies from its own.
struct Middles
{
  template<class CellState>
  void operator()(CellState& state, const float* points)
  {
    const vtkIdType polygons = state.GetNumberOfCells();
    at.resize(3 * static_cast<std::size_t>(polygons));
    float most2 = 0.0f;
    for (vtkIdType polygon = 0; polygon < polygons; ++polygon)
    {
      const auto corners = state.GetCellRange(polygon);
      float* middle = at.data() + 3 * polygon;
      for (const auto id : corners)
      {
        const float* p = points + 3 * id;
        for (int axis = 0; axis < 3; ++axis)
        {
          middle[axis] += p[axis];
        }
      }
      const float share = 1.0f / static_cast<float>(std::max<vtkIdType>(corners.size(), 1));
      for (int axis = 0; axis < 3; ++axis)
      {
        middle[axis] *= share;
      }
      for (const auto id : corners)
      {
        const float* p = points + 3 * id;
        const float d[3] = { p[0] - middle[0], p[1] - middle[1], p[2] - middle[2] };
        most2 = std::max(most2, d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
      }
    }
    reachMm = std::sqrt(most2);
  }

  std::vector<float> at;
  double reachMm = 0.0;
};

} // namespace

SonoSkinSurface::SonoSkinSurface(vtkPolyData* source)
  : points_(source->GetPoints())
  , polygons_(source->GetPolys())
  , time_(timeOf(source))
{
  mesh_->ShallowCopy(source);
  mesh_->SetVerts(nullptr);
  mesh_->SetLines(nullptr);
  mesh_->SetStrips(nullptr);
  mesh_->GetBounds(bounds_);
}

bool SonoSkinSurface::isMadeOf(vtkPolyData* source) const
{
  return points_ == source->GetPoints() && polygons_ == source->GetPolys() && time_ == timeOf(source);
}

bool SonoSkinSurface::sort()
{
  if (sorted_)
  {
    return false;
  }
  sorted_ = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double length = bounds_[2 * axis + 1] - bounds_[2 * axis];
    cubeMm_[axis] = std::max(cubeMm, length / mostCubes);
    count_[axis] = static_cast<int>(length / cubeMm_[axis]) + 1;
  }
  mesh_->BuildCells();
  weights_.resize(static_cast<std::size_t>(mesh_->GetMaxCellSize()));
  Middles middles;
  // Single precision, in which most meshes come.
  vtkSmartPointer<vtkFloatArray> points = vtkFloatArray::SafeDownCast(mesh_->GetPoints()->GetData());
  if (!points)
  {
    points = vtkSmartPointer<vtkFloatArray>::New();
    points->DeepCopy(mesh_->GetPoints()->GetData());
  }
  mesh_->GetPolys()->Visit(middles, points->GetPointer(0));
  reachMm_ = middles.reachMm + 1e-5 * vtkVector3d(bounds_[1], bounds_[3], bounds_[5]).Norm();

  const std::size_t polygons = middles.at.size() / 3;
  std::vector<int> cubeOf(polygons);
  first_.assign(std::size_t(count_[0]) * count_[1] * count_[2] + 1, 0);
  for (std::size_t i = 0; i < polygons; ++i)
  {
    int cube[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const double share = (middles.at[3 * i + axis] - bounds_[2 * axis]) / cubeMm_[axis];
      cube[axis] = std::clamp(static_cast<int>(share), 0, count_[axis] - 1);
    }
    cubeOf[i] = cube[0] + count_[0] * (cube[1] + count_[1] * cube[2]);
    ++first_[std::size_t(cubeOf[i]) + 1];
  }
  for (std::size_t cube = 1; cube < first_.size(); ++cube)
  {
    first_[cube] += first_[cube - 1];
  }
  inCube_.resize(polygons);
  std::vector<vtkIdType> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < polygons; ++i)
  {
    inCube_[std::size_t(next[std::size_t(cubeOf[i])]++)] = static_cast<vtkIdType>(i);
  }
  return true;
}

void SonoSkinSurface::range(const vtkVector3d& low, const vtkVector3d& high, int first[3], int last[3]) const
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto cube = [&](double at) {
      return std::floor(std::clamp((at - bounds_[2 * axis]) / cubeMm_[axis], -1.0, double(count_[axis])));
    };
    first[axis] = std::max(0, static_cast<int>(cube(low[axis] - reachMm_)));
    last[axis] = std::min(count_[axis] - 1, static_cast<int>(cube(high[axis] + reachMm_)));
  }
}

/// Calls `work` with each polygon that may touch a box, and some beside it.
template<class Work>
void SonoSkinSurface::forEachIn(const vtkVector3d& low, const vtkVector3d& high, const Work& work) const
{
  int first[3];
  int last[3];
  range(low, high, first, last);
  for (int z = first[2]; z <= last[2]; ++z)
  {
    for (int y = first[1]; y <= last[1] && first[0] <= last[0]; ++y)
    {
      const std::size_t row = std::size_t(count_[0]) * (std::size_t(y) + std::size_t(count_[1]) * z);
      std::for_each(inCube_.begin() + first_[row + first[0]], inCube_.begin() + first_[row + last[0] + 1], work);
    }
  }
}

vtkVector3d SonoSkinSurface::corner(vtkIdType polygon) const
{
  const vtkIdType* ids = nullptr;
  vtkIdType count = 0;
  mesh_->GetCellPoints(polygon, count, ids);
  vtkVector3d p(0.0);
  mesh_->GetPoint(ids[0], p.GetData());
  return p;
}

bool SonoSkinSurface::meet(const vtkVector3d& from, const vtkVector3d& to, double& t, double place[3],
                           vtkIdType& polygon)
{
  const vtkVector3d way = to - from;
  const double length = way.Norm();
  const vtkVector3d along = length > 0.0 ? way * (1.0 / length) : vtkVector3d(0.0);
  const int steps = std::max(1, static_cast<int>(std::ceil(length / cubeMm)));
  bool found = false;
  for (int step = 0; step < steps && t > static_cast<double>(step) / steps; ++step)
  {
    const vtkVector3d a = from + way * (static_cast<double>(step) / steps);
    const vtkVector3d b = from + way * (static_cast<double>(step + 1) / steps);
    vtkVector3d low;
    vtkVector3d high;
    for (int axis = 0; axis < 3; ++axis)
    {
      low[axis] = std::min(a[axis], b[axis]);
      high[axis] = std::max(a[axis], b[axis]);
    }
    forEachIn(low, high, [&](vtkIdType candidate) {
      // Most lie too far from the way for a closer look.
      if ((corner(candidate) - a).Cross(along).SquaredNorm() > 4.0 * reachMm_ * reachMm_)
      {
        return;
      }
      double share = 0.0;
      double there[3];
      double inCell[3];
      int part = 0;
      mesh_->GetCell(candidate, scratch_);
      if (scratch_->IntersectWithLine(from.GetData(), to.GetData(), 1e-6, share, there, inCell, part) && share < t)
      {
        t = share;
        std::copy(there, there + 3, place);
        polygon = candidate;
        found = true;
      }
    });
  }
  return found;
}

bool SonoSkinSurface::findNearest(const vtkVector3d& point, double& distance2, double place[3], vtkIdType& polygon)
{
  // The nearest of their first corners says how far the search has to go.
  double farMm = cubeMm;
  double cornerMm = VTK_DOUBLE_MAX;
  const auto around = [&](double mm, const auto& work) {
    forEachIn(point - vtkVector3d(mm), point + vtkVector3d(mm), work);
  };
  for (; cornerMm == VTK_DOUBLE_MAX; farMm *= 2.0)
  {
    around(farMm, [&](vtkIdType candidate) { cornerMm = std::min(cornerMm, (corner(candidate) - point).Norm()); });
  }
  bool found = false;
  around(cornerMm, [&](vtkIdType candidate) {
    if ((corner(candidate) - point).Norm() > std::min(cornerMm, std::sqrt(distance2)) + 2.0 * reachMm_)
    {
      return;
    }
    double there[3];
    double inCell[3];
    int part = 0;
    double apart2 = 0.0;
    mesh_->GetCell(candidate, scratch_);
    if (scratch_->EvaluatePosition(point.GetData(), there, part, inCell, apart2, weights_.data()) != -1 &&
        apart2 < distance2)
    {
      distance2 = apart2;
      std::copy(there, there + 3, place);
      polygon = candidate;
      found = true;
    }
  });
  return found;
}

/// Area times normal of a polygon.
vtkVector3d SonoSkinSurface::areaVector(vtkIdType polygon, vtkVector3d& centre) const
{
  const vtkIdType* ids = nullptr;
  vtkIdType count = 0;
  mesh_->GetCellPoints(polygon, count, ids);
  const auto point = [&](vtkIdType i) {
    vtkVector3d p;
    mesh_->GetPoint(ids[i], p.GetData());
    return p;
  };
  const vtkVector3d first = point(0);
  vtkVector3d sum(0.0);
  vtkVector3d before = first;
  centre = first;
  for (vtkIdType i = 1; i < count; ++i)
  {
    const vtkVector3d here = point(i);
    centre = centre + here;
    sum = sum + (before - first).Cross(here - first) * 0.5;
    before = here;
  }
  centre = centre * (1.0 / static_cast<double>(count));
  return sum;
}

vtkVector3d SonoSkinSurface::meanNormal(const vtkVector3d& middle, double radius, double sign,
                                        const vtkVector3d& facing) const
{
  vtkVector3d sum(0.0);
  forEachIn(middle - vtkVector3d(radius), middle + vtkVector3d(radius), [&](vtkIdType polygon) {
    vtkVector3d centre;
    const vtkVector3d area = areaVector(polygon, centre) * sign;
    const double share = (centre - middle).SquaredNorm() / (radius * radius);
    if (share < 1.0 && area.Dot(facing) > 0.0)
    {
      sum = sum + area * ((1.0 - share) * (1.0 - share));
    }
  });
  return sum.Norm() > 0.0 ? sum.Normalized() : facing;
}

vtkVector3d SonoSkinSurface::normalAt(const vtkVector3d& place, vtkIdType polygon, const vtkVector3d& side,
                                      double radius)
{
  vtkVector3d centre;
  vtkVector3d facing = areaVector(polygon, centre).Normalized();
  // The mesh may be wound inside out.
  const double sign = facing.Dot(side) < 0.0 ? -1.0 : 1.0;
  facing = facing * sign;
  if (radius > 0.0)
  {
    // First a small disc: one triangle of a noisy mesh may face anywhere.
    facing = meanNormal(place, radius / 3.0, sign, facing);
    facing = meanNormal(place, radius, sign, facing);
  }
  return facing;
}
