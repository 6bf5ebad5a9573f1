#include "Core/Simd.h"
#include "Probe/WindowGrid.h"

namespace sono {

namespace {

struct Axes
{
  double from[3], along[3], boxMm[3], perCellMm[3];
  int size[3];
};

SONO_SIMD_CLONES void findCells(const Axes& axes, const double* __restrict rMm, int count, double* __restrict x,
                                double* __restrict y, double* __restrict z, int* __restrict cell)
{
  const Axes a = axes;
  for (int n = 0; n < count; ++n)
  {
    x[n] = a.from[0] + rMm[n] * a.along[0];
    y[n] = a.from[1] + rMm[n] * a.along[1];
    z[n] = a.from[2] + rMm[n] * a.along[2];
    const int isInside = int(x[n] >= 0.0) & int(y[n] >= 0.0) & int(z[n] >= 0.0) & int(x[n] < a.boxMm[0]) &
                         int(y[n] < a.boxMm[1]) & int(z[n] < a.boxMm[2]);
    const int i = std::min(int(x[n] * a.perCellMm[0]), a.size[0] - 1);
    const int j = std::min(int(y[n] * a.perCellMm[1]), a.size[1] - 1);
    const int k = std::min(int(z[n] * a.perCellMm[2]), a.size[2] - 1);
    cell[n] = isInside ? i + a.size[0] * (j + a.size[1] * k) : -1;
  }
}

} // namespace

void WindowGrid::cellsAlong(const Vec3d& from, const Vec3d& axis, const double* rMm, int count, double* x, double* y,
                            double* z, int* cell) const
{
  Axes axes{};
  for (int a = 0; a < 3; ++a)
  {
    axes.from[a] = from[a];
    axes.along[a] = axis[a];
    axes.boxMm[a] = boxMm_[a];
    axes.perCellMm[a] = perCellMm_[a];
    axes.size[a] = size_[a];
  }
  findCells(axes, rMm, count, x, y, z, cell);
}

} // namespace sono
