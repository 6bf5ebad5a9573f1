#include "Channels/SurfacePoints.h"

#include "Core/ParallelFor.h"
#include "Core/SoundSpeed.h"
#include "Echo/SurfacePhase.h"

#include <cmath>

namespace sono {

namespace {

constexpr double coherentStepPerLambda = 0.45;
constexpr float leastShare = 0.01; ///< of a point's echo: what cancels more is left out

/// Adds the echoes of a brick's surfaces.
class SurfaceWalk
{
public:
  SurfaceWalk(const EchoSetup& setup, const FanPlaces& fan, const ProbeFrame& frame, const ProbeSettings& probe)
    : setup_(setup)
    , surfaces_(*setup.surfaces)
    , fan_(fan)
    , frame_(frame)
    , halfApertureMm_(float(0.5 * probe.apertureMm))
    , lambdaMm_(assumedSoundSpeedMmPerUs / setup.settings.centreFrequencyMHz)
    , perEcho_(setup.beams.focusAreaMm2() / lambdaMm_)
    , lines_(int(setup.lines.size()))
  {
    const LineSum sum = setup.finisher.emptySum();
    grid_ = lineGrid(sum);
    const Vec3f spacing = surfaces_.pieces().spacingMm();
    coherentCuts_ = { glm::max(Vec3i(glm::ceil(spacing / float(coherentStepPerLambda * lambdaMm_))), Vec3i(1)) };
    for (int line = 0; line < lines_; ++line)
    {
      beams_.push_back(setup.sceneBeam(line));
      intensities_.push_back(setup.finisher.intensity(line));
    }
  }

  void addPieces(const Vec3i& brick, ChannelPoints& out) const
  {
    const std::vector<SurfacePieces::Face>& faces = surfaces_.pieces().faces(brick);
    const SurfaceTable table = surfaces_.pieceTable();
    const float longestMm = surfaces_.longestStepMm();
    const Vec3f spacing = surfaces_.pieces().spacingMm();
    for (std::size_t f = 0; f < faces.size(); ++f)
    {
      const int row = surfaces_.rows().row(faces[f].below, faces[f].above);
      const Vec3f middle = faceMiddleMm(faces[f].voxel, faces[f].axis, spacing);
      const auto at = table.counts(row) ? placeIn(middle) : std::nullopt;
      if (!at || !(mostWeight(middle, 2.0f * longestMm, beams_[std::size_t(at->nearest())], grid_) > 0.0f))
      {
        continue;
      }
      if (const SurfacePiece* piece = surfaces_.pieces().piece(brick, f))
      {
        addPiece(*piece, row, *at, table, pieceBounds(*piece, longestMm).normal, out);
      }
    }
  }

  void addTarget(const SurfacePoint& point, ChannelPoints& out) const
  {
    const SurfaceTable table = surfaces_.targetTable();
    const auto at = placeIn(point.position);
    if (!at || !(mostWeight(point.position, 0.0f, beams_[std::size_t(at->nearest())], grid_) > 0.0f))
    {
      return;
    }
    const Heard heard = hear(point.position, point.normal, point.row, *at, table);
    addCoherent(point, 1.0f, heard, *at, table, out);
    addDiffuse(point, heard, *at, table, out);
  }

private:
  struct Heard
  {
    float lit;
    bool diffuse;
    bool coherent;
  };

  std::optional<FanPlaces::Place> placeIn(const Vec3f& local) const
  {
    const Vec3d place = frame_.fromWorld(setup_.sources.scene->worldFromLocal(Vec3d(local)));
    return fan_.at(place.x, place.z);
  }

  /// How much steeper a surface may be that is mirrored from some element to another.
  float apertureTangent(float depthMm) const { return halfApertureMm_ / larger(depthMm, halfApertureMm_); }
  /// A tangent that counts for a beam, and so much more as the aperture's ends see a surface from the side.
  float widened(float reach, float depthMm) const { return reach < 0.0f ? reach : reach + apertureTangent(depthMm); }
  /// What its neighbours leave of a point's coherent echo, of a piece whose blobs are so wide (see SurfaceEcho.h): the
  /// Gaussian's own, towards the direction in which an element comes nearest to a mirror. It fades the surface out
  /// where it cancels, without an edge that would echo.
  float shareLeft(const Vec3f& normal, float blobMm, const FanPlaces::Place& at) const
  {
    const float along = glm::dot(normal, beams_[std::size_t(at.nearest())].axis);
    const float tangent = sqrtf(larger(0.0f, 1.0f - along * along)) / larger(fabsf(along), 1e-3f);
    const float excess =
      float(2.0 * 6.283185307179586 / lambdaMm_) * blobMm * larger(0.0f, tangent - apertureTangent(at.depthMm));
    return expNegative(-0.5f * excess * excess);
  }

  Heard hear(const Vec3f& position, const Vec3f& normal, int rowFromA, const FanPlaces::Place& at,
             const SurfaceTable& table) const
  {
    const Beam& beam = beams_[std::size_t(at.nearest())];
    const float along = glm::dot(normal, beam.axis);
    const float cosSquared = along * along;
    const float sinSquared = larger(0.0f, 1.0f - cosSquared);
    const SurfaceRow& row = table.rows[along < 0.0f ? rowFromA ^ 1 : rowFromA];
    const bool diffuse = withinTangent(row.reach, cosSquared, sinSquared);
    const bool coherent = withinTangent(widened(row.finestReach, at.depthMm), cosSquared, sinSquared);
    if (!diffuse && !coherent)
    {
      return { 0.0f, false, false };
    }
    const BeamPlace place = placeInBeam(position.x, position.y, position.z, beam, grid_);
    const float depthMm = place.position / grid_.samplesPerMm;
    const float fromMm =
      litFromMm(place, depthMm, glm::dot(normal, beam.lateral), glm::dot(normal, beam.elevation), along, table);
    const SurfaceIntensity& intensity = intensities_[std::size_t(at.nearest())];
    const float arrives = intensity.bins ? intensityOfBins(intensity, fromMm, depthMm, row.decayPerMm) : 1.0f;
    const float lit = shapedLit(arrives, along, row);
    return { lit, diffuse && lit > surfaceFaintestLit, coherent && lit > surfaceFaintestLit };
  }

  void addPiece(const SurfacePiece& piece, int row, const FanPlaces::Place& at, const SurfaceTable& table,
                const Vec3f& normal, ChannelPoints& out) const
  {
    const Heard heard = hear(piece.positionMm, normal, row, at, table);
    if (heard.coherent)
    {
      const PieceNet net = coherentCuts_.of(piece.axis, surfaces_.pieces().spacingMm());
      const PieceNet blobs = surfaces_.nets().coherentNet(piece);
      const float blobMm = float(0.5 * blobPerStep) * (blobs.stepU + blobs.stepV);
      for (int n = 0; n < net.points(); ++n)
      {
        SurfacePoint point = piecePoint(piece, net, n);
        point.row = row;
        addCoherent(point, shareLeft(point.normal, blobMm, at), heard, at, table, out);
      }
    }
    if (heard.diffuse)
    {
      const PieceNet net = surfaces_.nets().diffuseNet(piece);
      for (int n = 0; n < net.points(); ++n)
      {
        SurfacePoint point = piecePoint(piece, net, n);
        point.row = row;
        setPhase(setup_.settings.seed, piece.voxel, piece.axis, std::uint32_t(n), point);
        addDiffuse(point, heard, at, table, out);
      }
    }
  }

  struct Meeting
  {
    float signedCosine;
    float cosSquared;
    float sinSquared;
    const SurfaceRow* row;
  };
  Meeting meet(const SurfacePoint& point, const Beam& beam, const SurfaceTable& table) const
  {
    const float cosine = glm::dot(point.normal, beam.axis);
    return { cosine, cosine * cosine, larger(0.0f, 1.0f - cosine * cosine),
             &table.rows[cosine < 0.0f ? point.row ^ 1 : point.row] };
  }

  void addCoherent(const SurfacePoint& point, float share, const Heard& heard, const FanPlaces::Place& at,
                   const SurfaceTable& table, ChannelPoints& out) const
  {
    const Meeting m = meet(point, beams_[std::size_t(at.nearest())], table);
    if (heard.coherent && share > leastShare &&
        isWithin(widened(m.row->finestReach, at.depthMm), m.cosSquared, m.sinSquared))
    {
      const float amplitude = coherentStrength(table, *m.row, fabsf(m.signedCosine), point.areaMm2) * heard.lit * share;
      push(point.position, 0.0f, -float(perEcho_) * amplitude, 1.0f, at, out);
    }
  }

  void addDiffuse(const SurfacePoint& point, const Heard& heard, const FanPlaces::Place& at, const SurfaceTable& table,
                  ChannelPoints& out) const
  {
    const Beam& beam = beams_[std::size_t(at.nearest())];
    const Meeting m = meet(point, beam, table);
    if (!heard.diffuse || !isWithin(m.row->reach, m.cosSquared, m.sinSquared))
    {
      return;
    }
    const float node = diffuseNode(table, fabsf(m.signedCosine), m.sinSquared);
    const int before = int(node);
    const float share = node - float(before);
    const int n = m.row->profile * table.nodes + before;
    const float logL = table.diffuseL[n] + share * (table.diffuseL[n + 1] - table.diffuseL[n]);
    const float logE = table.diffuseE[n] + share * (table.diffuseE[n + 1] - table.diffuseE[n]);
    const float amplitude = float(perEcho_) * heard.lit *
                            diffuseStrength(m.row->logDiffuse, logL, logE, glm::dot(point.normal, beam.lateral),
                                            glm::dot(point.normal, beam.elevation), point.areaMm2);
    push(point.position, amplitude * point.phaseRe, amplitude * point.phaseIm, 0.0f, at, out);
  }

  void push(const Vec3f& local, float re, float im, float rise, const FanPlaces::Place& at, ChannelPoints& out) const
  {
    const FanPlaces::Arrival arrival = fan_.arrival(at);
    out.push(Vec3f(frame_.fromWorld(setup_.sources.scene->worldFromLocal(Vec3d(local)))), re, im, arrival.lagMm,
             arrival.sinkNp, rise);
  }

  const EchoSetup& setup_;
  const SurfaceEchoes& surfaces_;
  const FanPlaces& fan_;
  const ProbeFrame& frame_;
  float halfApertureMm_;
  double lambdaMm_;
  double perEcho_; // A_b / lambda
  int lines_;
  LineGrid grid_{};
  PieceCuts coherentCuts_{};
  std::vector<Beam> beams_;
  std::vector<SurfaceIntensity> intensities_;
};

} // namespace

ChannelPoints surfacePoints(const EchoSetup& setup, const FanPlaces& fan, const ProbeFrame& frame,
                            const ProbeSettings& probe, const Progress& progress)
{
  const SurfaceWalk walk(setup, fan, frame, probe);
  std::vector<BeamReach> beams;
  for (int line = 0; line < int(setup.lines.size()); ++line)
  {
    beams.push_back(setup.beams.reachOf(setup.sceneBeam(line), setup.finisher.reachMm(line)));
  }
  ChannelPoints out;
  std::vector<SurfacePoint> targetPoints;
  for (const TargetGroup& targets : setup.surfaces->targets())
  {
    forSeenBricks(targets.pieces.grid(), beams, [&](const Vec3i& brick, const std::vector<std::size_t>&) {
      targets.pieces.cutBrick(brick, targetPoints);
      for (const SurfacePoint& point : targetPoints)
      {
        walk.addTarget(point, out);
      }
    });
  }
  std::vector<Vec3i> bricks;
  forSeenBricks(setup.surfaces->pieceGrid(), setup.surfaces->seeingPieces(beams),
                [&](const Vec3i& brick, const std::vector<std::size_t>&) { bricks.push_back(brick); });
  std::vector<ChannelPoints> found(bricks.size());
  parallelFor(int(bricks.size()), progress,
              [&](int b) { walk.addPieces(bricks[std::size_t(b)], found[std::size_t(b)]); });
  for (const ChannelPoints& points : found)
  {
    out.append(points);
  }
  return out;
}

} // namespace sono
