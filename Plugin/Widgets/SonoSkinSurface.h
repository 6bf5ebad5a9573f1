#pragma once

#include "vtkGenericCell.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkVector.h"

#include <vector>

/// One mesh to stand on. Its polygons are sorted by their middles into cubes of some millimetres, in two passes over
/// them: a skin has millions, and sorting them as VTK's locators do holds the first step of a drag up for a second.
class SonoSkinSurface
{
public:
  explicit SonoSkinSurface(vtkPolyData* source);

  /// Whether that is the same mesh: a pipeline hands the same arrays on in a new one each time it runs.
  bool isMadeOf(vtkPolyData* source) const;
  /// World mm, as VTK orders them.
  const double* bounds() const { return bounds_; }

  /// Sorts the polygons where that was not done yet; what follows needs it. True when there was something to do.
  bool sort();
  /// Where the way from `from` to `to` first meets a polygon, at less than the share `t` of it: then true, and `t`,
  /// `place` and `polygon` are set.
  bool meet(const vtkVector3d& from, const vtkVector3d& to, double& t, double place[3], vtkIdType& polygon);
  /// The same for the place nearest to a point, at less than the squared distance `distance2`.
  bool findNearest(const vtkVector3d& point, double& distance2, double place[3], vtkIdType& polygon);
  /// The unit normal at a place on a polygon, on the side that `side` points to: the mean over the polygons within
  /// `radius` mm that face alike.
  vtkVector3d normalAt(const vtkVector3d& place, vtkIdType polygon, const vtkVector3d& side, double radius);

private:
  template<class Work>
  void forEachIn(const vtkVector3d& low, const vtkVector3d& high, const Work& work) const;
  void range(const vtkVector3d& low, const vtkVector3d& high, int first[3], int last[3]) const;
  vtkVector3d corner(vtkIdType polygon) const;
  vtkVector3d areaVector(vtkIdType polygon, vtkVector3d& centre) const;
  vtkVector3d meanNormal(const vtkVector3d& middle, double radius, double sign, const vtkVector3d& facing) const;

  vtkSmartPointer<vtkPoints> points_;
  vtkSmartPointer<vtkCellArray> polygons_;
  vtkMTimeType time_;
  vtkNew<vtkPolyData> mesh_;
  vtkNew<vtkGenericCell> scratch_;
  std::vector<double> weights_; ///< of a polygon's corners; of no use, but VTK writes them
  double bounds_[6];
  bool sorted_ = false;
  int count_[3]; ///< of cubes along each axis
  vtkVector3d cubeMm_;
  double reachMm_ = 0.0;          ///< from a polygon's middle to its farthest corner, at most
  std::vector<vtkIdType> first_;  ///< of each cube in inCube_, and the end
  std::vector<vtkIdType> inCube_; ///< polygons by cube
};
