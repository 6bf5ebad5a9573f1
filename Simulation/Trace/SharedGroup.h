#pragma once

#include "Core/ParallelFor.h"
#include "Kernel/TracePath.h"
#include "Trace/Deposit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

// Neighbouring lines that share their paths. A path of one line also stands for a path of each other line of its group:
// one that leaves that line's own first boundary by the same branch, meets the path in the point where it crosses its
// second boundary, and goes on as it does (Bekaert, Sbert and Halton 2002, "Accelerating path tracing by re-using
// paths", joined at the second vertex). What a path leaves on line k is weighted by the balance heuristic (Veach 1997),
// p_k / sum over the group's lines j of p_j, with the density p_j with which line j would have drawn it: branch and
// lobe at both boundaries, per area of the face where they meet. So the mean of every line is what its own paths alone
// would give.

namespace sono {

/// Branches at the first boundary.
enum FirstBranch
{
  Transmitted = 0,
  Reflected = 1,
  FirstBranches = 2
};

/// A line of a group and what its paths leave.
struct GroupLine
{
  const TraceLine* line;
  const LineStart* start;
  std::array<LineTally*, FirstBranches> tally;
  std::array<double, FirstBranches> weight{}; ///< sum of the weights; its mean is paths x probability of the branch
  Vec3f restart{};                            ///< where its paths leave the first boundary

  float firstShare(int branch) const
  {
    const float r = start->boundary.reflection.reflectance;
    return branch == Reflected ? r : 1.0f - r;
  }
};

/// The lines of a group as the kernel sees them: a path goes on as far as it may for any of them.
struct GroupBeams
{
  const GroupLine* first;
  int count;
  float slackMm; ///< how much shorter than the path's own the way of another line to it can be
};

inline float remainingLength(const TraceView& view, const GroupBeams& beams, const PathState& path)
{
  float most = 0.0f;
  for (int k = 0; k < beams.count; ++k)
  {
    most = larger(most, remainingLength(view.depthMm, *beams.first[k].line, path.ray.position, path.ray.direction,
                                        path.length - beams.slackMm));
  }
  return most;
}

/// A piece of a path, and the echo of the boundary at its end if the path met one there.
struct SharedPiece
{
  PathSegment segment;
  bool echoes;
  Vec3f echoPoint;
  float echoAmplitude;
  float echoTau; ///< how the amplitude goes with the intensity
};

/// Keeps pieces.
struct PieceList : PathSink
{
  std::vector<SharedPiece> pieces;

  void segment(const PathSegment& s) { pieces.push_back({ s, false, Vec3f(0.0f), 0.0f, 1.0f }); }
  void echo(const Vec3f& point, float amplitude)
  {
    pieces.back().echoes = true;
    pieces.back().echoPoint = point;
    pieces.back().echoAmplitude = amplitude;
  }
};

/// One line's way to the joint of a path.
struct PathJoin
{
  PieceList way;
  PathBoundary boundary;  ///< the second boundary as this line's path meets it
  float intensity = 1.0f; ///< on arrival
  float density;          ///< p_k; 0 when the line cannot draw the path
};

/// A path as the line that drew it followed it.
struct DrawnPath
{
  int owner;
  bool reflected;  ///< at its first boundary
  Vec3f direction; ///< from there
  bool meets;      ///< a second boundary
  bool alone;      ///< meets it where it left the first one
  Vec3f joint;     ///< where it crosses that
  bool leaves;     ///< the second boundary again, not ending there
  bool reflectedAgain;
  Vec3f directionAgain;
  PieceList rest; ///< from the second boundary on
};

/// Hears the path that a line draws, from its first boundary on: its way to the second one, how it meets and leaves
/// that, and the rest.
class DrawnPathSink : public PathSink
{
public:
  DrawnPathSink(const TraceView& view, DrawnPath& drawn, PathJoin& own)
    : view_(view)
    , drawn_(drawn)
    , own_(own)
    , pieces_(&own.way)
  {
  }

  void segment(const PathSegment& s) { pieces_->segment(s); }
  void meets(const PathState& path, const PathBoundary& boundary)
  {
    tau_ = view_.media[boundary.after.medium].tau;
    if (drawn_.meets)
    {
      return;
    }
    drawn_.meets = true;
    drawn_.leaves = path.collisions < view_.maxCollisions;
    drawn_.joint = path.ray.position + path.ray.direction * boundary.restart;
    own_.boundary = boundary;
    own_.intensity = path.intensity;
  }
  void echo(const Vec3f& point, float amplitude)
  {
    pieces_->echo(point, amplitude);
    pieces_->pieces.back().echoTau = tau_;
  }
  void left(const PathState& path, const PathBoundary& boundary)
  {
    if (pieces_ == &drawn_.rest)
    {
      return;
    }
    drawn_.reflectedAgain = path.tissue == boundary.before.medium;
    drawn_.directionAgain = path.ray.direction;
    pieces_ = &drawn_.rest;
  }

private:
  const TraceView& view_;
  DrawnPath& drawn_;
  PathJoin& own_;
  PieceList* pieces_;
  float tau_ = 1.0f;
};

/// What a group needs while it runs, kept from group to group.
struct GroupScratch
{
  DrawnPath path;
  std::vector<PathJoin> joins;
};

template<class Space>
class SharedGroup
{
public:
  /// The lines' first boundaries must part the same media.
  SharedGroup(const TraceView& view, const Space& space, std::vector<GroupLine>& lines, GroupScratch& scratch)
    : view_(view)
    , space_(space)
    , lines_(lines)
    , path_(scratch.path)
    , joins_(scratch.joins)
  {
    joins_.resize(std::max(joins_.size(), lines.size()));
    for (GroupLine& k : lines_)
    {
      k.restart = k.start->path.ray.position + k.start->path.ray.direction * k.start->boundary.restart;
    }
    float slack = 0.0f;
    for (const GroupLine& a : lines_)
    {
      for (const GroupLine& b : lines_)
      {
        slack =
          larger(slack, glm::length(a.restart - b.restart) + std::fabs(a.start->path.length - b.start->path.length));
      }
    }
    beams_ = { lines_.data(), int(lines_.size()), slack };
  }

  /// One batch of `paths` paths of every line; the key's path is replaced. All the paths of the group are one
  /// low-discrepancy set. Returns the number of segments traced.
  std::uint64_t trace(PathKey key, int paths, const YieldPoint& yieldPoint)
  {
    std::uint64_t segments = 0;
    for (int owner = 0; owner < int(lines_.size()); ++owner)
    {
      for (int i = 0; i < paths; ++i)
      {
        key.path = std::uint32_t(owner) * std::uint32_t(paths) + std::uint32_t(i);
        if (key.path > 0 && key.path % pathsPerFold == 0)
        {
          fold();
          yieldPoint();
        }
        path_.owner = owner;
        segments += follow(key);
        double total = 0.0;
        for (int k = 0; k < int(lines_.size()); ++k)
        {
          segments += join(k);
          total += joins_[std::size_t(k)].density;
        }
        for (int k = 0; k < int(lines_.size()); ++k)
        {
          const PathJoin& j = joins_[std::size_t(k)];
          if (j.density > 0.0f)
          {
            deposit(lines_[std::size_t(k)], j, float(j.density / total));
          }
        }
      }
    }
    return segments;
  }

private:
  void fold()
  {
    for (const GroupLine& line : lines_)
    {
      for (LineTally* tally : line.tally)
      {
        tally->fold();
      }
    }
  }

  /// The owner's path.
  std::uint64_t follow(const PathKey& key)
  {
    const LineStart& start = *lines_[std::size_t(path_.owner)].start;
    PathJoin& own = joins_[std::size_t(path_.owner)];
    own.way.pieces.clear();
    path_.rest.pieces.clear();
    path_.meets = path_.leaves = path_.alone = false;
    PathState path = start.path;
    leaveBoundary(view_, space_, start.boundary, firstBounceSample(key.scrambles[0], key.path), path);
    path_.reflected = path.tissue == start.boundary.before.medium;
    path_.direction = path.ray.direction;
    DrawnPathSink sink(view_, path_, own);
    bool goesOn = true;
    while (goesOn)
    {
      goesOn = stepPath(view_, space_, beams_, key, path, sink);
    }
    path_.alone = startsAtJoint(lines_[std::size_t(path_.owner)]);
    return own.way.pieces.size() + path_.rest.pieces.size();
  }

  /// Where three tissues meet a path may find its second boundary in the very point in which it leaves the first one.
  /// Per area of the joint its density is then beyond all bounds, and against it no other line's counts: it stands for
  /// itself alone. A line whose own paths start in the joint of another's cannot lead there.
  bool startsAtJoint(const GroupLine& line) const
  {
    constexpr float coincidentMm = 1e-6f;
    const Vec3f across = path_.joint - line.restart;
    return path_.meets && glm::dot(across, across) < coincidentMm * coincidentMm;
  }

  /// Line k's way to the joint, or along the same direction when the path meets no second boundary, and the density of
  /// the whole. Returns the number of segments traced.
  std::uint64_t join(int k)
  {
    const GroupLine& line = lines_[std::size_t(k)];
    PathJoin& j = joins_[std::size_t(k)];
    const bool owner = k == path_.owner;
    if (path_.alone || startsAtJoint(line))
    {
      j.density = owner ? 1.0f : 0.0f;
      return 0;
    }
    const Vec3f across = path_.joint - line.restart;
    const Vec3f direction = owner || !path_.meets ? path_.direction : glm::normalize(across);
    const PathBoundary& first = line.start->boundary;
    j.density = scatterDensity(view_.lobe, line.start->path.ray.direction, first.surface.normal, first.cosine,
                               first.reflection, path_.reflected, direction);
    std::uint64_t segments = 0;
    if (!owner && j.density > 0.0f)
    {
      segments = walk(line, direction, j);
    }
    if (path_.meets && j.density > 0.0f)
    {
      const BoundarySide& from = j.boundary.before;
      const BoundarySide& to = j.boundary.after;
      const Vec3f face = j.boundary.voxelFace ? Vec3f(to.cell - from.cell) : j.boundary.surface.normal;
      j.density *= std::fabs(glm::dot(direction, face)) / glm::dot(across, across);
      if (path_.leaves)
      {
        j.density *= scatterDensity(view_.lobe, direction, j.boundary.surface.normal, j.boundary.cosine,
                                    j.boundary.reflection, path_.reflectedAgain, path_.directionAgain);
      }
    }
    // The path was drawn, whatever rounding makes of its density at the rim of a lobe.
    j.density = owner ? larger(j.density, 1e-30f) : j.density;
    return segments;
  }

  std::uint64_t walk(const GroupLine& line, const Vec3f& direction, PathJoin& j)
  {
    j.way.pieces.clear();
    PathState path = line.start->path;
    takeBranch(space_, line.start->boundary, Scattered{ direction, path_.reflected, 1.0f }, path);
    const bool meets = advanceToBoundary(view_, space_, beams_, path, j.boundary, j.way);
    j.intensity = path.intensity;
    if (meets != path_.meets || (meets && !sameCrossing(j.boundary, path)))
    {
      j.density = 0.0f;
    }
    else if (path_.leaves)
    {
      depositBoundary(view_, path, j.boundary, j.way);
    }
    return j.way.pieces.size();
  }

  bool sameCrossing(const PathBoundary& b, const PathState& path) const
  {
    const PathBoundary& own = joins_[std::size_t(path_.owner)].boundary;
    if (b.voxelFace != own.voxelFace || b.after.medium != own.after.medium || b.before.medium != own.before.medium)
    {
      return false;
    }
    const Vec3f apart = path.ray.position + path.ray.direction * b.restart - path_.joint;
    return b.voxelFace ? b.before.cell == own.before.cell && b.after.cell == own.after.cell
                       : b.after.target == own.after.target && glm::dot(apart, apart) < 1e-6f;
  }

  /// Leaves the joined path on line k, as far as that line's own limits let it go.
  void deposit(GroupLine& line, const PathJoin& j, float weight)
  {
    const int branch = path_.reflected ? Reflected : Transmitted;
    line.weight[std::size_t(branch)] += weight;
    LineTally& tally = *line.tally[std::size_t(branch)];
    float length = line.start->path.length;
    for (const SharedPiece& piece : j.way.pieces)
    {
      if (!depositPiece(line, tally, piece, weight, weight, length))
      {
        return;
      }
    }
    const float ratio = j.intensity / joins_[std::size_t(path_.owner)].intensity;
    for (const SharedPiece& piece : path_.rest.pieces)
    {
      const float echoRatio = piece.echoTau == 1.0f ? ratio : std::pow(ratio, piece.echoTau);
      if (!depositPiece(line, tally, piece, weight * ratio, weight * echoRatio, length))
      {
        return;
      }
    }
  }

  bool depositPiece(const GroupLine& line, LineTally& tally, const SharedPiece& piece, float factor, float echoFactor,
                    float& length)
  {
    PathSegment s = piece.segment;
    const float most = remainingLength(view_.depthMm, *line.line, s.start, s.direction, length);
    const bool whole = s.length <= most;
    s.length = smaller(s.length, most);
    s.intensity *= factor;
    length += s.length;
    tally.segment(s);
    if (whole && piece.echoes)
    {
      tally.echo(piece.echoPoint, piece.echoAmplitude * echoFactor);
    }
    return whole;
  }

  const TraceView& view_;
  const Space& space_;
  std::vector<GroupLine>& lines_;
  DrawnPath& path_;
  std::vector<PathJoin>& joins_;
  GroupBeams beams_{};
};

} // namespace sono
