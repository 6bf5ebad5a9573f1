#pragma once

#include "Probe/ScanGeometry.h"
#include "Probe/WindowGrid.h"

#include <utility>
#include <vector>

namespace sono {

/// A probe that is moved over the skin of a grid: where it can stand, and what its lines meet there. Places and
/// directions are local (Scene.h).
class ProbeOnSkin
{
public:
  static constexpr int lineCount = 49;
  static constexpr double shadowDb = 12.0; ///< loss beyond that of soft tissue from which on a place is in a shadow

  ProbeOnSkin(const WindowGrid& grid, const ProbeSettings& probe);

  const WindowGrid& grid() const { return grid_; }
  /// Of the search: few lines, of a matrix those of its middle plane, and 1.3 times as deep as the probe's own, which
  /// is what a depth knob is for.
  const ScanGeometry& geometry() const { return geometry_; }
  bool isLinear() const { return geometry_.kind == ScanKind::Linear; }

  /// Whether hand and handle have air around them, which also keeps the probe out of airways.
  bool hasRoom(const Vec3d& place, const Vec3d& axis) const;
  /// Whether the face lies on skin: at five points along it, and at two across, at least five of the seven.
  bool touches(const Vec3d& place, const Vec3d& axis, const Vec3d& lateral) const;

  /// The area that a step of a line stands for in an image, mm^2, by its number from the face.
  std::vector<double> stepAreas(const std::vector<ScanLine>& lines) const;

  /// Walks through the grid: visit(r, local place, cell, loss and what of it is beyond that of soft tissue, dB, one
  /// way) at each step of WindowGrid::stepMm() within the box.
  template<class Visit>
  void walk(const Vec3d& from, const Vec3d& axis, double lengthMm, const Visit& visit) const
  {
    constexpr int together = 64; // steps
    const std::size_t tissueCount = lossOfStep_.size();
    const double stepMm = grid_.stepMm();
    const double softOfStep = softLossOfMm_ * stepMm;
    double rMm[together];
    GridSteps<together> steps;
    int last = -1;
    double lossDb = 0.0;
    double softDb = 0.0;
    for (double r = 0.5 * stepMm; r < lengthMm;)
    {
      int count = 0;
      for (; count < together && r < lengthMm; r += stepMm)
      {
        rMm[count++] = r;
      }
      grid_.cellsAlong(from, axis, rMm, count, steps.x, steps.y, steps.z, steps.cell);
      for (int n = 0; n < count; ++n)
      {
        if (steps.cell[n] < 0)
        {
          continue;
        }
        const auto cell = std::size_t(steps.cell[n]);
        const int tissue = grid_.tissue(cell);
        const bool isGel = last < 0 && grid_.isOuter(cell); // between the face and the skin
        if (!isGel)
        {
          lossDb += lossOfStep_[std::size_t(tissue)];
          softDb += softOfStep;
          lossDb += last >= 0 ? lossOfBoundary_[std::size_t(last) * tissueCount + std::size_t(tissue)] : 0.0;
          last = tissue;
        }
        visit(rMm[n], Vec3d(steps.x[n], steps.y[n], steps.z[n]), cell, lossDb, lossDb > softDb ? lossDb - softDb : 0.0);
      }
    }
  }

  /// Steps from the first to before the last of a walk that lie within the box; the grid's box is convex.
  std::pair<int, int> stepsInside(const Vec3d& from, const Vec3d& axis, double lengthMm) const;

private:
  /// Where so many steps lie.
  template<int count>
  struct GridSteps
  {
    double x[count], y[count], z[count];
    int cell[count];
  };

  void lookUpLosses(double frequencyMHz);

  const WindowGrid& grid_;
  ScanGeometry geometry_;
  double halfFaceMm_ = 0.0;
  std::vector<double> lossOfStep_;     // dB, by tissue
  std::vector<double> lossOfBoundary_; // dB, from a tissue to another
  double softLossOfMm_ = 0.0;
};

} // namespace sono
