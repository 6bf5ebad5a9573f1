#include "Echo/SurfaceEchoes.h"

#include "Core/Policy.h"
#include "Core/Simd.h"
#include "Core/SoundSpeed.h"
#include "Echo/FaintPieces.h"
#include "Echo/HeardSurfaces.h"
#include "Echo/LayOutPieces.h"
#include "Echo/SurfaceLoops.h"
#include "Echo/SurfacePhase.h"

#include <algorithm>
#include <cmath>
#include <functional>
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
/// Faces are heard at least so many at once, of several bricks. Beams that are no Gaussians, which weigh each by
/// itself, do so brick by brick: one sees few of those that its neighbours see.
constexpr std::size_t facesTogether = 64;

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
    if (ringingRod((*targets)[t]))
    {
      media.rods.push_back(int(media.all.size()));
    }
    media.all.push_back((*targets)[t].tissue);
  }
  return media;
}

/// values[n] = values[from[n]], of numbers that rise.
void takeEach(const std::vector<std::int32_t>& from, std::vector<std::int32_t>& values)
{
  const std::int32_t* const at = from.data();
  std::int32_t* const of = values.data();
  for (std::size_t n = 0; n < from.size(); ++n)
  {
    of[n] = of[at[n]]; // none overtakes another
  }
}

PieceCuts cutsFor(const Vec3f& spacingMm, double stepMm)
{
  return { glm::max(Vec3i(glm::ceil(spacingMm / float(stepMm))), Vec3i(1)) };
}

} // namespace

/// The lines that are added to, and how they hear.
struct SurfaceEchoes::Group
{
  const std::vector<BeamReach>& beams;
  const std::vector<SurfaceIntensity>& intensities;
  std::vector<LineSum>& sums;
  std::vector<LineGrid> grids;
  SurfaceTable table;
};

/// A brick that lines see, with those of its faces that count.
struct SurfaceEchoes::MetBrick
{
  Vec3i brick;
  const SurfacePieces::Face* faces;
  std::size_t count;
  std::vector<std::size_t> seeing; ///< lines, ascending
};

/// What is known of some bricks that follow each other: one alone has few faces.
struct SurfaceEchoes::Room
{
  std::vector<MetBrick> bricks; ///< the first `met` of them
  std::size_t met = 0;
  std::size_t faceCount = 0;          ///< of these
  std::vector<std::size_t> listening; ///< lines that see any of them, ascending
  FaceList faces;
  std::vector<std::vector<std::int32_t>> mayHear; ///< by line; of the list's faces, then of the pieces
  std::vector<std::int32_t> anyMayHear;           ///< of the list's faces
  std::vector<std::int32_t> faceOf;               ///< by piece: which of them; not of targets
  PieceList pieces;
  PieceShapes shapes;                         ///< of the pieces; not of targets
  PieceExtents extents;                       ///< the same
  std::vector<const SurfacePiece*> pieceOf;   ///< by piece; not of targets
  std::vector<int> rowOf;                     ///< the same
  std::vector<HeardList> heard;               ///< by line
  std::vector<float> anyDiffuse, anyCoherent; ///< of the pieces: not 0 where any line hears that echo
  PointList diffuse, coherent;
  std::vector<SurfacePoint> targets;

  void meet(const Vec3i& brick, const SurfacePieces::Face* ofBrick, std::size_t count,
            const std::vector<std::size_t>& seeing)
  {
    bricks.resize(std::max(bricks.size(), met + 1));
    MetBrick& b = bricks[met++];
    b.brick = brick;
    b.faces = ofBrick;
    b.count = count;
    b.seeing = seeing;
    faceCount += count;
  }
  void forget() { met = faceCount = 0; }
  void findListening(std::size_t lines)
  {
    std::vector<char> listens(lines, 0);
    for (std::size_t b = 0; b < met; ++b)
    {
      for (const std::size_t i : bricks[b].seeing)
      {
        listens[i] = 1;
      }
    }
    listening.clear();
    for (std::size_t i = 0; i < lines; ++i)
    {
      if (listens[i])
      {
        listening.push_back(i);
      }
    }
  }
  /// Lines hear none of the faces of bricks that they do not see.
  void leaveUnseen()
  {
    std::size_t first = 0;
    for (std::size_t b = 0; b < met; ++b)
    {
      const std::vector<std::size_t>& seeing = bricks[b].seeing;
      for (const std::size_t i : listening)
      {
        if (!std::binary_search(seeing.begin(), seeing.end(), i))
        {
          std::fill_n(mayHear[i].begin() + std::ptrdiff_t(first), bricks[b].count, 0);
        }
      }
      first += bricks[b].count;
    }
  }
  /// Pieces of faces; without `diffuseMost` targets, which have none.
  void hear(const std::vector<std::size_t>& seeing, const Group& group, const float* diffuseMost)
  {
    heard.resize(group.beams.size());
    for (const std::size_t i : seeing)
    {
      const Beam& beam = group.beams[i].beam;
      const LineGrid& grid = group.grids[i];
      hearPieces(pieces, diffuseMost ? mayHear[i].data() : nullptr, beam, grid, group.table, group.intensities[i],
                 heard[i]);
      if (diffuseMost)
      {
        leaveFaint(pieces, extents, beam, grid, group.table, diffuseMost, heard[i]);
      }
    }
  }
  /// Of all lines that see the brick; they have heard it.
  void findHeard(const std::vector<std::size_t>& seeing)
  {
    const auto add = [](const std::vector<float>& ofLine, std::vector<float>& any) {
      std::transform(any.begin(), any.end(), ofLine.begin(), any.begin(), [](float a, float b) { return a + b; });
    };
    anyDiffuse.assign(std::size_t(pieces.count), 0.0f);
    anyCoherent.assign(std::size_t(pieces.count), 0.0f);
    for (const std::size_t i : seeing)
    {
      if (heard[i].anyDiffuse)
      {
        add(heard[i].diffuse, anyDiffuse);
      }
      if (heard[i].anyCoherent)
      {
        add(heard[i].coherent, anyCoherent);
      }
    }
  }
  void addTo(const std::vector<std::size_t>& seeing, const Group& group)
  {
    diffuse.pad();
    coherent.pad();
    for (const std::size_t i : seeing)
    {
      const Beam& beam = group.beams[i].beam;
      float* iq = group.sums[i].iq.data();
      if (heard[i].anyDiffuse)
      {
        addDiffusePoints(diffuse, heard[i], beam, group.grids[i], group.table, iq);
      }
      if (heard[i].anyCoherent)
      {
        addCoherentPoints(coherent, heard[i], beam, group.grids[i], group.table, iq);
      }
    }
  }
};

std::shared_ptr<SurfaceEchoes::Room> SurfaceEchoes::makeRoom()
{
  return std::make_shared<Room>();
}

SurfaceEchoes::SurfaceEchoes(const Scene& scene, const std::vector<TargetSurface>* targets,
                             const EchoSettings& settings, const BeamModel& beams, SurfaceDetail detail)
  : pieces_(scene.surfacePieces())
  , isCoarse_(detail == SurfaceDetail::Coarse)
  , seed_(settings.seed)
{
  const BeamExtent beam = beamExtent(beams);
  blobMm_ = sono::blobMm(settings, beam);
  const double lambdaMm = assumedSoundSpeedMmPerUs / settings.centreFrequencyMHz;
  const double diffuseSteps = isCoarse_ ? interactiveDiffuseSteps : 1.0;
  const double widestSteps = isCoarse_ ? interactiveWidestSteps : 1.0;
  const double turns = isCoarse_ ? interactiveTurns : 1.0;
  const Vec3f spacing = pieces_.spacingMm() * Vec3f(isCoarse_ ? pieces_.coarseApart() : Vec3i(1));
  nets_.spacingMm = spacing;
  nets_.diffuse = cutsFor(spacing, diffuseSteps * diffuseStepPerLambda * lambdaMm);
  nets_.most = cutsFor(spacing, blobMm_ / blobPerStep).cuts;
  nets_.fewest = glm::min(nets_.most, cutsFor(spacing, widestSteps * widestPerSigma / blobPerStep *
                                                         std::min(beam.lateralSigmaMm, beam.elevationalSigmaMm))
                                        .cuts);
  nets_.cutsPerMm = float(blobPerStep * std::sqrt(2.0 * pi / lambdaMm / (turns * mostTurnRad)));
  const float widestMm =
    float(blobPerStep) * std::max({ spacing.x / float(nets_.fewest.x), spacing.y / float(nets_.fewest.y),
                                    spacing.z / float(nets_.fewest.z) });
  rows_ = sharedSurfaceRows(mediaOf(scene, targets), settings, beam, blobMm_, widestMm);
  std::vector<int> silent;
  for (std::size_t t = 0; targets && t < targets->size(); ++t)
  {
    if (const auto rod = ringingRod((*targets)[t]))
    {
      const std::vector<int> alone{ int(t) };
      targets_.push_back(
        { { scene, *targets, alone, *rows_, edgePerBlob * blobMm_, seed_ }, rodRing(*rod, settings), nullptr });
    }
    else
    {
      silent.push_back(int(t));
    }
  }
  if (!silent.empty())
  {
    targets_.push_back({ { scene, *targets, silent, *rows_, edgePerBlob * blobMm_, seed_ }, {}, nullptr });
  }
  if (settings.field)
  {
    pieceSight_ = std::make_unique<FieldSight>(*settings.field, pieces_.edgeMm());
    for (TargetGroup& group : targets_)
    {
      group.sight = std::make_unique<FieldSight>(*settings.field, group.pieces.grid().edgeMm);
    }
  }
}

void SurfaceEchoes::findPieces(const Group& group, Room& room) const
{
  const float longestMm = longestStepMm();
  room.faces.clear();
  room.faces.reserve(int(room.faceCount));
  for (std::size_t b = 0; b < room.met; ++b)
  {
    for (std::size_t n = 0; n < room.bricks[b].count; ++n)
    {
      const SurfacePieces::Face& face = room.bricks[b].faces[n];
      const int row = rows_->row(face.below, face.above);
      room.faces.push(faceMiddleMm(face.voxel, face.axis, pieces_.spacingMm()), face.roughNormal, rows_->at(row),
                      rows_->at(row ^ 1));
    }
  }
  room.findListening(group.beams.size());
  room.mayHear.resize(group.beams.size());
  for (const std::size_t i : room.listening)
  {
    room.mayHear[i].resize(std::size_t(inWholeVectors(int(room.faceCount))));
    markHeard(room.faces, 2.0f * longestMm, group.beams[i].beam, group.grids[i], room.mayHear[i].data());
  }
  room.leaveUnseen();
  room.anyMayHear.assign(room.faceCount, 0);
  for (const std::size_t i : room.listening)
  {
    std::transform(room.anyMayHear.begin(), room.anyMayHear.end(), room.mayHear[i].begin(), room.anyMayHear.begin(),
                   std::bit_or<>());
  }
  room.pieces.clear();
  room.shapes.clear();
  room.pieceOf.clear();
  room.rowOf.clear();
  room.faceOf.clear();
  std::size_t first = 0;
  for (std::size_t b = 0; b < room.met; ++b)
  {
    const MetBrick& brick = room.bricks[b];
    for (std::size_t n = 0; n < brick.count; ++n)
    {
      if (room.anyMayHear[first + n] == 0)
      {
        continue;
      }
      const int row = rows_->row(brick.faces[n].below, brick.faces[n].above);
      const SurfacePiece* piece = group.table.counts(row) ? pieces_.piece(brick.brick, n) : nullptr;
      if (piece)
      {
        // Pieces lie all over the memory, and are asked for while the next are looked up.
        __builtin_prefetch(piece);
        __builtin_prefetch(reinterpret_cast<const char*>(piece + 1) - 1);
        room.faceOf.push_back(std::int32_t(first + n));
        room.pieceOf.push_back(piece);
        room.rowOf.push_back(row);
      }
    }
    first += brick.count;
  }
  for (const std::size_t i : room.listening)
  {
    takeEach(room.faceOf, room.mayHear[i]);
  }
  for (std::size_t p = 0; p < room.pieceOf.size(); ++p)
  {
    room.pieces.place(room.pieceOf[p]->positionMm, room.rowOf[p]);
    room.shapes.push(*room.pieceOf[p]);
  }
  layOutPieces(room.shapes, nets_, longestMm, group.table, room.pieces, room.extents);
}

void SurfaceEchoes::addMet(Group& group, Room& room) const
{
  findPieces(group, room);
  if (room.pieces.count > 0)
  {
    room.hear(room.listening, group, rows_->diffuseMost().data());
    expand(room);
    room.addTo(room.listening, group);
  }
  room.forget();
}

void SurfaceEchoes::expand(Room& room) const
{
  room.findHeard(room.listening);
  room.diffuse.clear();
  room.coherent.clear();
  for (std::size_t p = 0; p < room.pieceOf.size(); ++p)
  {
    const SurfacePiece& piece = *room.pieceOf[p];
    const int row = room.pieces.row[p];
    if (room.anyDiffuse[p] > 0.0f)
    {
      const int first = room.diffuse.count;
      addNet(piece, nets_.diffuseNet(piece), row, int(p), room.diffuse);
      setPhases(seed_, piece.voxel, piece.axis, first, room.diffuse);
    }
    if (room.anyCoherent[p] > 0.0f)
    {
      addNet(piece, nets_.coherentNet(piece), row, int(p), room.coherent);
    }
  }
}

BrickGrid SurfaceEchoes::pieceGrid() const
{
  return { pieces_.edgeMm(), Vec3f(0.0f), pieces_.sizeMm() };
}

float SurfaceEchoes::longestStepMm() const
{
  return std::max({ nets_.spacingMm.x, nets_.spacingMm.y, nets_.spacingMm.z });
}

std::vector<BeamReach> SurfaceEchoes::seeingPieces(std::vector<BeamReach> beams) const
{
  for (BeamReach& beam : beams)
  {
    beam.sight = pieceSight_.get();
    // Points lie up to a piece and a half outside of their brick, and are lit from a little further in front.
    beam.marginMm = 1.5f * longestStepMm();
    beam.depthMm += beam.depthMm > 0.0f ? surfaceCrossingMm + beam.marginMm : 0.0f;
  }
  return beams;
}

std::vector<BeamReach> SurfaceEchoes::seeingTargets(std::vector<BeamReach> beams, const TargetGroup& targets)
{
  for (BeamReach& beam : beams)
  {
    beam.sight = targets.sight.get();
    beam.depthMm += beam.depthMm > 0.0f ? surfaceCrossingMm : 0.0f;
  }
  return beams;
}

SurfaceTable SurfaceEchoes::pieceTable() const
{
  const Vec3f spacing = pieces_.spacingMm();
  return rows_->view(std::cbrt(spacing.x * spacing.y * spacing.z));
}

void SurfaceEchoes::addTargets(const TargetGroup& targets, std::vector<BeamReach> beams, const YieldPoint& brickDone,
                               Group& group, Room& room) const
{
  beams = seeingTargets(std::move(beams), targets);
  forSeenBricks(targets.pieces.grid(), beams, [&](const Vec3i& brick, const std::vector<std::size_t>& seeing) {
    brickDone();
    room.pieces.clear();
    room.diffuse.clear();
    room.coherent.clear();
    targets.pieces.cutBrick(brick, room.targets);
    for (const SurfacePoint& point : room.targets)
    {
      room.diffuse.push(point, room.pieces.count);
      room.coherent.push(point, room.pieces.count);
      room.pieces.push(point.position, point.normal, 0.0f, false, point.row, group.table);
    }
    room.hear(seeing, group, nullptr);
    room.addTo(seeing, group);
  });
}

void SurfaceEchoes::add(std::vector<BeamReach> beams, const std::vector<SurfaceIntensity>& intensities,
                        const YieldPoint& brickDone, Room& room, std::vector<LineSum>& sums) const
{
  const std::vector<BeamReach> exact = beams;
  Group group{ exact, intensities, sums, {}, targetTable() };
  for (const LineSum& sum : sums)
  {
    group.grids.push_back(lineGrid(sum));
  }
  for (const TargetGroup& targets : targets_)
  {
    if (targets.ring.taps.empty())
    {
      addTargets(targets, beams, brickDone, group, room);
      continue;
    }
    std::vector<LineSum> alone;
    for (const LineSum& sum : sums)
    {
      alone.push_back({ std::vector<float>(sum.iq.size(), 0.0f), sum.sampleMm, sum.radPerMm });
    }
    Group ringing{ exact, intensities, alone, group.grids, targetTable() };
    addTargets(targets, beams, brickDone, ringing, room);
    for (std::size_t i = 0; i < sums.size(); ++i)
    {
      addRung(targets.ring, alone[i].iq, sums[i].iq);
    }
  }
  beams = seeingPieces(std::move(beams));
  group.table = pieceTable();
  const std::size_t most = isGaussian(exact.front().beam) ? facesTogether : 1;
  forSeenBricks(pieceGrid(), beams, [&](const Vec3i& brick, const std::vector<std::size_t>& seeing) {
    brickDone();
    const std::vector<SurfacePieces::Face>& faces = pieces_.faces(brick);
    const std::size_t count = isCoarse_ ? pieces_.coarseCount(brick) : faces.size();
    if (count == 0)
    {
      return;
    }
    // A brick lies anywhere in memory: it is asked for while others are met.
    pieces_.prefetch(brick);
    room.meet(brick, faces.data(), count, seeing);
    if (room.faceCount >= most)
    {
      addMet(group, room);
    }
  });
  addMet(group, room);
}

} // namespace sono
