#include "Echo/SurfaceEchoes.h"

#include "Core/SoundSpeed.h"
#include "Echo/SurfacePhase.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sono {

namespace {

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

} // namespace

SurfaceEchoes::SurfaceEchoes(const Scene& scene, const std::vector<TargetSurface>* targets,
                             const EchoSettings& settings, const BeamModel& beams)
  : pieces_(scene.surfacePieces())
  , seed_(settings.seed)
{
  const BeamExtent beam = beamExtent(beams);
  blobMm_ = sono::blobMm(settings, beam);
  rows_ = std::make_unique<SurfaceRows>(mediaOf(scene, targets), scene.outsideIndex(), settings, beam, blobMm_);
  net_.cuts = glm::max(Vec3i(glm::ceil(pieces_.spacingMm() * float(blobPerStep / blobMm_))), Vec3i(1));
  net_.stepMm = pieces_.spacingMm() / Vec3f(net_.cuts);
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
  const int row = rows_->row(piece.below, piece.above);
  std::uint32_t number = 0;
  for (int j = 0; j < net_.cuts[(piece.axis + 2) % 3]; ++j)
  {
    for (int i = 0; i < net_.cuts[(piece.axis + 1) % 3]; ++i)
    {
      SurfacePoint point = piecePoint(piece, net_, i, j);
      point.row = row;
      setPhases(seed_, piece.voxel, piece.axis, number++, point);
      points.push_back(point);
    }
  }
}

BrickGrid SurfaceEchoes::pieceGrid() const
{
  return { pieces_.edgeMm(), Vec3f(0.0f), pieces_.sizeMm() };
}

float SurfaceEchoes::marginMm() const
{
  const Vec3f spacing = pieces_.spacingMm();
  return std::max({ spacing.x, spacing.y, spacing.z });
}

std::vector<BeamReach> SurfaceEchoes::seeingPieces(std::vector<BeamReach> beams) const
{
  for (BeamReach& beam : beams)
  {
    beam.sight = pieceSight_.get();
    beam.marginMm = marginMm();
  }
  return beams;
}

SurfaceTable SurfaceEchoes::pieceTable() const
{
  const Vec3f spacing = pieces_.spacingMm();
  return rows_->view(std::cbrt(spacing.x * spacing.y * spacing.z));
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
    const SurfaceTable table = targetTable();
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
  beams = seeingPieces(std::move(beams));
  const SurfaceTable table = pieceTable();
  std::vector<std::size_t> hearing;
  forSeenBricks(pieceGrid(), beams, [&](const Vec3i& brick, const std::vector<std::size_t>& seeing) {
    for (const SurfacePiece& piece : pieces_.brick(brick))
    {
      const int row = rows_->row(piece.below, piece.above);
      hearing.clear();
      for (const std::size_t i : seeing)
      {
        if (pieceCounts(table, piece, row, exact[i].beam.axis))
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
