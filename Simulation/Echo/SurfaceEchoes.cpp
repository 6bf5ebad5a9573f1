#include "Echo/SurfaceEchoes.h"

#include "Core/Simd.h"
#include "Core/SoundSpeed.h"
#include "Echo/SurfacePhase.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
/// Blobs are flat: of a wavelength this much, however bent the surface is, keeps a sphere of 5 mm within 0.2 dB; the
/// bending of a wider one may turn the phase by so much over its deviation. Of the beam's deviation half to all, since
/// blobs are taken off its width.
constexpr double blobPerLambda = 0.3;
constexpr double mostTurnRad = 0.12;
constexpr double blobPerSigma = 0.5;
constexpr double widestPerSigma = 0.75;
/// A triangle's longest edge for such a blob, three times as wide as the triangle.
constexpr double edgePerBlob = 1.6;
/// Diffuse echoes need no more points than speckle does.
constexpr double diffuseStepPerLambda = 1.2;

double blobMm(const EchoSettings& s, const BeamExtent& beam)
{
  return std::min(blobPerLambda * assumedSoundSpeedMmPerUs / s.centreFrequencyMHz,
                  blobPerSigma * std::min(beam.lateralSigmaMm, beam.elevationalSigmaMm));
}

SurfaceMedia mediaOf(const Scene& scene, const std::vector<TargetSurface>* targets)
{
  SurfaceMedia media{ scene.tissues(), int(scene.tissues().size()), scene.outsideIndex() };
  for (std::size_t t = 0; targets && t < targets->size(); ++t)
  {
    media.all.push_back((*targets)[t].tissue);
  }
  return media;
}

PieceCuts cutsFor(const Vec3f& spacingMm, double stepMm)
{
  return { glm::max(Vec3i(glm::ceil(spacingMm / float(stepMm))), Vec3i(1)) };
}

/// What one line hears of a piece.
struct Listener
{
  std::size_t line;
  SurfaceHearing hearing;
};

SONO_SIMD_CLONES __attribute__((flatten)) void addDiffusePoints(const SurfacePoint* points, int count, const Beam& beam,
                                                                const LineGrid& grid, const SurfaceTable& table,
                                                                const SurfaceHearing& heard, float* iq)
{
  SurfaceSum sum{ iq };
  for (int n = 0; n < count; ++n)
  {
    addDiffuse(points[n], beam, grid, table, heard, sum);
  }
}

SONO_SIMD_CLONES __attribute__((flatten)) void addCoherentPoints(const SurfacePoint* points, int count,
                                                                 const Beam& beam, const LineGrid& grid,
                                                                 const SurfaceTable& table, const SurfaceHearing& heard,
                                                                 float* iq)
{
  SurfaceSum sum{ iq };
  for (int n = 0; n < count; ++n)
  {
    addCoherent(points[n], beam, grid, table, heard, sum);
  }
}

} // namespace

SurfaceEchoes::SurfaceEchoes(const Scene& scene, const std::vector<TargetSurface>* targets,
                             const EchoSettings& settings, const BeamModel& beams)
  : pieces_(scene.surfacePieces())
  , seed_(settings.seed)
{
  const BeamExtent beam = beamExtent(beams);
  blobMm_ = sono::blobMm(settings, beam);
  const double lambdaMm = assumedSoundSpeedMmPerUs / settings.centreFrequencyMHz;
  const Vec3f spacing = pieces_.spacingMm();
  nets_.spacingMm = spacing;
  nets_.diffuse = cutsFor(spacing, diffuseStepPerLambda * lambdaMm);
  nets_.most = cutsFor(spacing, blobMm_ / blobPerStep).cuts;
  nets_.fewest = glm::min(
    nets_.most,
    cutsFor(spacing, widestPerSigma / blobPerStep * std::min(beam.lateralSigmaMm, beam.elevationalSigmaMm)).cuts);
  nets_.cutsPerMm = float(blobPerStep * std::sqrt(2.0 * pi / lambdaMm / mostTurnRad));
  const float widestMm =
    float(blobPerStep) * std::max({ spacing.x / float(nets_.fewest.x), spacing.y / float(nets_.fewest.y),
                                    spacing.z / float(nets_.fewest.z) });
  rows_ = sharedSurfaceRows(mediaOf(scene, targets), settings, beam, blobMm_, widestMm);
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

int SurfaceEchoes::expand(const SurfacePiece& piece, bool coherent, std::vector<SurfacePoint>& points) const
{
  points.clear();
  const int row = rows_->row(piece.below, piece.above);
  const PieceNet diffuseNet = nets_.diffuseNet(piece);
  const int diffuse = diffuseNet.points();
  for (int n = 0; n < diffuse; ++n)
  {
    points.push_back(piecePoint(piece, diffuseNet, n));
    points.back().row = row;
    setPhases(seed_, piece.voxel, piece.axis, std::uint32_t(n), points.back());
  }
  const PieceNet net = nets_.coherentNet(piece);
  for (int n = 0; coherent && n < net.points(); ++n)
  {
    points.push_back(piecePoint(piece, net, n));
    points.back().row = row;
  }
  return diffuse;
}

BrickGrid SurfaceEchoes::pieceGrid() const
{
  return { pieces_.edgeMm(), Vec3f(0.0f), pieces_.sizeMm() };
}

float SurfaceEchoes::longestStepMm() const
{
  const Vec3f spacing = pieces_.spacingMm();
  return std::max({ spacing.x, spacing.y, spacing.z });
}

std::vector<BeamReach> SurfaceEchoes::seeingPieces(std::vector<BeamReach> beams) const
{
  for (BeamReach& beam : beams)
  {
    beam.sight = pieceSight_.get();
    // Points lie up to a voxel and a half outside of their brick, and are lit from a little further in front.
    beam.marginMm = 1.5f * longestStepMm();
    beam.depthMm += beam.depthMm > 0.0f ? surfaceCrossingMm + beam.marginMm : 0.0f;
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
      beam.depthMm += beam.depthMm > 0.0f ? surfaceCrossingMm : 0.0f;
    }
    const SurfaceTable table = targetTable();
    forSeenBricks(targets_->grid(), beams, [&](const Vec3i& brick, const std::vector<std::size_t>& seeing) {
      for (const SurfacePoint& point : targets_->brick(brick))
      {
        for (const std::size_t i : seeing)
        {
          const Beam& beam = exact[i].beam;
          const SurfaceHearing heard =
            hearSurface(point.position, point.normal, 0.0f, false, point.row, beam, grids[i], table, intensities[i]);
          float* iq = sums[i].iq.data();
          addDiffusePoints(&point, heard.diffuse ? 1 : 0, beam, grids[i], table, heard, iq);
          addCoherentPoints(&point, heard.coherent ? 1 : 0, beam, grids[i], table, heard, iq);
        }
      }
    });
  }
  beams = seeingPieces(std::move(beams));
  const SurfaceTable table = pieceTable();
  const float longestMm = longestStepMm();
  std::vector<Listener> listeners;
  forSeenBricks(pieceGrid(), beams, [&](const Vec3i& brick, const std::vector<std::size_t>& seeing) {
    const std::vector<SurfacePieces::Face>& faces = pieces_.faces(brick);
    for (std::size_t f = 0; f < faces.size(); ++f)
    {
      const SurfacePieces::Face& face = faces[f];
      const int row = rows_->row(face.below, face.above);
      const Vec3f middle = pieces_.middleMm(face);
      const auto mayHear = [&](std::size_t i) {
        return mayHearSurface(middle, face.roughNormal, 2.0f * longestMm, row, exact[i].beam, grids[i], table);
      };
      if (!table.counts(row) || std::none_of(seeing.begin(), seeing.end(), mayHear))
      {
        continue;
      }
      const SurfacePiece* there = pieces_.piece(brick, f);
      if (!there)
      {
        continue;
      }
      const SurfacePiece& piece = *there;
      const PieceBounds bounds = pieceBounds(piece, longestMm);
      const bool isCoarse = nets_.isCoarsest(nets_.coherentCuts(piece));
      listeners.clear();
      bool isCoherent = false;
      for (const std::size_t i : seeing)
      {
        const SurfaceHearing heard = hearSurface(piece.positionMm, bounds.normal, bounds.radiusMm, isCoarse, row,
                                                 exact[i].beam, grids[i], table, intensities[i]);
        if (heard.lit > 0.0f)
        {
          listeners.push_back({ i, heard });
          isCoherent |= heard.coherent;
        }
      }
      if (listeners.empty())
      {
        continue;
      }
      const int diffuse = expand(piece, isCoherent, points);
      for (const Listener& l : listeners)
      {
        const Beam& beam = exact[l.line].beam;
        float* iq = sums[l.line].iq.data();
        addDiffusePoints(points.data(), l.hearing.diffuse ? diffuse : 0, beam, grids[l.line], table, l.hearing, iq);
        addCoherentPoints(points.data() + diffuse, l.hearing.coherent ? int(points.size()) - diffuse : 0, beam,
                          grids[l.line], table, l.hearing, iq);
      }
    }
  });
}

} // namespace sono
