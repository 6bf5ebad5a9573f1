#include "Echo/SurfaceEchoes.h"

#include "Core/SoundSpeed.h"
#include "Echo/SurfacePhase.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

/// Deviation of a blob on a square net of step 1: the net shows through by exp(-2 pi^2 0.49) = 6e-5.
constexpr double blobPerStep = 0.7;
/// Blobs are flat; this much of a wavelength keeps a sphere of 5 mm within 0.2 dB. Of the beam's deviation half, since
/// blobs are taken off its width.
constexpr double blobPerLambda = 0.3;
constexpr double blobPerSigma = 0.5;
/// A triangle's longest edge for such a blob, three times as wide as the triangle.
constexpr double edgePerBlob = 1.6;

double blobMm(const EchoSettings& s, const BeamExtent& beam)
{
  return std::min(blobPerLambda * assumedSoundSpeedMmPerUs / s.centreFrequencyMHz,
                  blobPerSigma * std::min(beam.lateralSigmaMm, beam.elevationalSigmaMm));
}

std::vector<Tissue> mediaOf(const Scene& scene, const std::vector<TargetSurface>* targets)
{
  std::vector<Tissue> media = scene.tissues();
  for (std::size_t t = 0; targets && t < targets->size(); ++t)
  {
    media.push_back((*targets)[t].tissue);
  }
  return media;
}

/// The axis of a beam against the tangents of its boundaries.
bool counts(const SurfaceTable& table, const SurfacePiece& piece, int row, const Beam& beam)
{
  Vec3f normal(0.0f);
  normal[piece.axis] = 1.0f;
  normal[(piece.axis + 1) % 3] = -piece.slopeU;
  normal[(piece.axis + 2) % 3] = -piece.slopeV;
  const float along = glm::dot(normal, beam.axis);
  // A little more, since its points' normals differ.
  const float reach = table.rows[along < 0.0f ? row ^ 1 : row].reach + 0.1f;
  const float squared = along * along;
  return reach > 0.1f && glm::dot(normal, normal) - squared < reach * reach * squared;
}

} // namespace

SurfaceEchoes::SurfaceEchoes(const Scene& scene, const std::vector<TargetSurface>* targets,
                             const EchoSettings& settings, const BeamModel& beams)
  : pieces_(scene.surfacePieces())
  , seed_(settings.seed)
{
  const BeamExtent beam = beamExtent(beams);
  blobMm_ = sono::blobMm(settings, beam);
  rows_ = std::make_unique<SurfaceRows>(mediaOf(scene, targets), scene.outsideIndex(), settings, beam, blobMm_);
  cuts_ = glm::max(Vec3i(glm::ceil(pieces_.spacingMm() * float(blobPerStep / blobMm_))), Vec3i(1));
  if (targets && !targets->empty())
  {
    targets_ = std::make_unique<TargetPieces>(scene, *targets, *rows_, edgePerBlob * blobMm_, seed_);
  }
  if (settings.field)
  {
    pieceSight_ = std::make_unique<FieldSight>(*settings.field, pieces_.edgeMm());
    targetSight_ = targets_ ? std::make_unique<FieldSight>(*settings.field, targets_->grid().edgeMm) : nullptr;
  }
}

void SurfaceEchoes::expand(const SurfacePiece& piece, std::vector<SurfacePoint>& points) const
{
  points.clear();
  const int axis = piece.axis;
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const Vec3f step = pieces_.spacingMm() / Vec3f(cuts_);
  SurfacePoint point;
  point.row = rows_->row(piece.below, piece.above);
  std::uint32_t number = 0;
  for (int j = 0; j < cuts_[v]; ++j)
  {
    for (int i = 0; i < cuts_[u]; ++i)
    {
      const float du = (float(i) + 0.5f - 0.5f * float(cuts_[u])) * step[u];
      const float dv = (float(j) + 0.5f - 0.5f * float(cuts_[v])) * step[v];
      const float slopeU = piece.slopeU + piece.bendUU * du + piece.bendUV * dv;
      const float slopeV = piece.slopeV + piece.bendUV * du + piece.bendVV * dv;
      const float stretch = std::sqrt(1.0f + slopeU * slopeU + slopeV * slopeV);
      point.position = piece.positionMm;
      point.position[u] += du;
      point.position[v] += dv;
      point.position[axis] += 0.5f * ((piece.slopeU + slopeU) * du + (piece.slopeV + slopeV) * dv);
      point.normal[axis] = 1.0f / stretch;
      point.normal[u] = -slopeU / stretch;
      point.normal[v] = -slopeV / stretch;
      const float blobU = float(blobPerStep) * step[u];
      const float blobV = float(blobPerStep) * step[v];
      point.tangentU = point.tangentV = Vec3f(0.0f);
      point.tangentU[u] = blobU;
      point.tangentU[axis] = blobU * slopeU;
      point.tangentV[v] = blobV;
      point.tangentV[axis] = blobV * slopeV;
      point.areaMm2 = piece.share * stretch * step[u] * step[v];
      setPhases(seed_, piece.voxel, std::uint32_t(axis), number++, point);
      points.push_back(point);
    }
  }
}

void SurfaceEchoes::add(std::vector<BeamReach> beams, const std::vector<SurfaceIntensity>& intensities,
                        std::vector<LineSum>& sums) const
{
  std::vector<LineGrid> grids;
  for (const LineSum& sum : sums)
  {
    grids.push_back(makeLineGrid(sum.sampleMm, sum.radPerMm, sum.sampleCount()));
  }
  const std::vector<BeamReach> exact = beams;
  std::vector<SurfacePoint> points;
  if (targets_)
  {
    for (BeamReach& beam : beams)
    {
      beam.sight = targetSight_.get();
    }
    const SurfaceTable table = rows_->view(0.0);
    forSeenBricks(targets_->grid(), beams, [&](const Vec3i& brick, const std::vector<std::size_t>& seeing) {
      for (const SurfacePoint& point : targets_->brick(brick))
      {
        for (const std::size_t i : seeing)
        {
          addSurface(point, exact[i].beam, grids[i], table, intensities[i], sums[i].iq.data());
        }
      }
    });
  }
  const Vec3f spacing = pieces_.spacingMm();
  const float longest = std::max({ spacing.x, spacing.y, spacing.z });
  for (BeamReach& beam : beams)
  {
    beam.sight = pieceSight_.get();
    beam.marginMm = longest; // pieces may lie a voxel outside of their brick
  }
  const SurfaceTable table = rows_->view(std::cbrt(spacing.x * spacing.y * spacing.z));
  std::vector<std::size_t> hearing;
  const BrickGrid grid{ pieces_.edgeMm(), Vec3f(0.0f), pieces_.sizeMm() };
  forSeenBricks(grid, beams, [&](const Vec3i& brick, const std::vector<std::size_t>& seeing) {
    for (const SurfacePiece& piece : pieces_.brick(brick))
    {
      const int row = rows_->row(piece.below, piece.above);
      hearing.clear();
      for (const std::size_t i : seeing)
      {
        if (counts(table, piece, row, exact[i].beam))
        {
          hearing.push_back(i);
        }
      }
      if (!hearing.empty())
      {
        expand(piece, points);
        for (const std::size_t i : hearing)
        {
          for (const SurfacePoint& point : points)
          {
            addSurface(point, exact[i].beam, grids[i], table, intensities[i], sums[i].iq.data());
          }
        }
      }
    }
  });
}

} // namespace sono
