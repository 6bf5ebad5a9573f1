#include "Echo/BrickWalk.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

/// A beam with what the tests of a brick's centre need.
struct BeamCulling
{
  BeamReach reach;
  std::size_t index;
  Vec3f radius; ///< the centre of a seen brick is no further from the axis, along x, y and z
  float axial;  ///< half a brick's extent along the beam's three directions
  float lateral;
  float elevation;
  Vec2f perWidening{ 1.0f }; ///< of a beam of an aperture or an array, by its angle
  ArraySightView array{};    ///< of a beam of an array
  // Of an aperture's beam, for the layer of bricks that is looked at: between these depths it is nowhere wider.
  float layerFromMm = 0.0f;
  float layerToMm = -1.0f;
  Vec2f perLayerWidth{ 0.0f };
  bool isInLayer = false;
  Vec2f besideMm{ 0.0f }; ///< no centre that is seen in the layer is further from the axis, lateral and elevational
  Vec3f perBrick{ 0.0f }; ///< of one brick along a row: 1 / change of depth, lateral and elevational place, 1/mm
};

float halfExtent(const Vec3f& direction, float edge)
{
  return 0.5f * edge * (std::fabs(direction.x) + std::fabs(direction.y) + std::fabs(direction.z));
}

Vec2f wideningOf(const BeamReach& reach)
{
  const ApertureProfile& p = reach.beam.profile;
  if (reach.array)
  {
    return Vec2f(1.0f / reach.beam.lateralCosine, 1.0f / reach.beam.elevationalCosine);
  }
  return reach.table ? Vec2f(1.0f / std::sqrt(p.lateral.cosine2), 1.0f / std::sqrt(p.elevational.cosine2))
                     : Vec2f(1.0f);
}

/// Between two depths; those of an aperture's beam depend on them.
Vec3f seenRadius(const BeamReach& reach, float edge, float fromMm, float toMm)
{
  const Beam& b = reach.beam;
  if (reach.table)
  {
    const Vec2f seen = reach.table->widest(fromMm, toMm) * wideningOf(reach) * reach.share;
    return glm::abs(b.lateral) * seen.x + glm::abs(b.elevation) * seen.y + 0.5f * edge * std::sqrt(3.0f);
  }
  if (reach.sight)
  {
    return glm::abs(b.lateral) * reach.sight->lateralMm() + glm::abs(b.elevation) * reach.sight->elevationalMm();
  }
  return Vec3f(beamCutSigma * reach.share * std::max(b.lateralSigmaMm, b.elevationalSigmaMm) +
               0.5f * edge * std::sqrt(3.0f));
}

std::vector<BeamCulling> makeBeamCulling(const std::vector<BeamReach>& group, float edge)
{
  std::vector<BeamCulling> beams;
  for (std::size_t i = 0; i < group.size(); ++i)
  {
    const Beam& b = group[i].beam;
    if (group[i].depthMm > group[i].fromMm)
    {
      const float margin = group[i].marginMm;
      beams.push_back({ group[i], i, seenRadius(group[i], edge, 0.0f, group[i].depthMm) + margin,
                        halfExtent(b.axis, edge) + margin, halfExtent(b.lateral, edge) + margin,
                        halfExtent(b.elevation, edge) + margin, 1.0f / wideningOf(group[i]),
                        group[i].array ? group[i].array->view() : ArraySightView{} });
    }
  }
  return beams;
}

bool sees(const BeamCulling& s, const Vec3f& centre)
{
  const Beam& b = s.reach.beam;
  const Vec3f q = centre - b.origin;
  const float r = glm::dot(q, b.axis);
  if (r <= s.reach.fromMm - s.axial || r >= s.reach.depthMm + s.axial)
  {
    return false;
  }
  const float lateral = glm::dot(q, b.lateral);
  const float elevational = glm::dot(q, b.elevation);
  if (s.reach.sight)
  {
    return s.reach.sight->sees(lateral, elevational, r);
  }
  if (s.reach.array)
  {
    return s.array.sees(std::max(0.0f, std::fabs(lateral) - s.lateral) * s.perWidening.x,
                        std::max(0.0f, std::fabs(elevational) - s.elevation) * s.perWidening.y, r - s.axial,
                        r + s.axial);
  }
  if (s.reach.table)
  {
    const float asideL = std::max(0.0f, std::fabs(lateral) - s.lateral) * s.perWidening.x;
    const float asideE = std::max(0.0f, std::fabs(elevational) - s.elevation) * s.perWidening.y;
    const float most = s.reach.share * s.reach.share;
    if (r - s.axial >= s.layerFromMm && r + s.axial <= s.layerToMm)
    {
      const float l = asideL * s.perLayerWidth.x;
      const float e = asideE * s.perLayerWidth.y;
      if (l * l + e * e > 1.001f * most) // most bricks, without a look into the table
      {
        return false;
      }
    }
    const Vec2f seen = s.reach.table->widest(r - s.axial, r + s.axial);
    const float dl = asideL / seen.x;
    const float de = asideE / seen.y;
    return dl * dl + de * de < most;
  }
  const float dl = std::max(0.0f, std::fabs(lateral) - s.lateral) / b.lateralSigmaMm;
  const float de = std::max(0.0f, std::fabs(elevational) - s.elevation) / b.elevationalSigmaMm;
  const float cut = beamCutSigma * s.reach.share;
  return dl * dl + de * de < cut * cut;
}

/// The axis that the beams follow most.
int mainAxis(const std::vector<BeamCulling>& beams)
{
  Vec3f heading(0.0f);
  for (const BeamCulling& s : beams)
  {
    heading += glm::abs(s.reach.beam.axis);
  }
  return heading.x >= heading.y && heading.x >= heading.z ? 0 : (heading.y >= heading.z ? 1 : 2);
}

/// The box around all that the beams see, inside the grid's.
void clipBox(const std::vector<BeamCulling>& beams, Vec3f& low, Vec3f& high)
{
  Vec3f seenLow(1e30f);
  Vec3f seenHigh(-1e30f);
  for (const BeamCulling& s : beams)
  {
    const Vec3f from = s.reach.beam.origin + s.reach.beam.axis * s.reach.fromMm;
    const Vec3f to = s.reach.beam.origin + s.reach.beam.axis * s.reach.depthMm;
    seenLow = glm::min(seenLow, glm::min(from, to) - s.radius);
    seenHigh = glm::max(seenHigh, glm::max(from, to) + s.radius);
  }
  low = glm::max(low, seenLow);
  high = glm::min(high, seenHigh);
}

/// The part of a beam's axis inside the slab low <= x[axis] <= high, as depths, by so much beyond the beam's ends;
/// empty when from > to.
Vec2f clipToSlab(const BeamReach& b, int axis, float low, float high, float beyondMm = 0.0f)
{
  const float fromMm = b.fromMm - beyondMm;
  const float toMm = b.depthMm + beyondMm;
  const float o = b.beam.origin[axis];
  const float d = b.beam.axis[axis];
  if (std::fabs(d) < 1e-6f)
  {
    return o < low || o > high ? Vec2f(fromMm + 1.0f, fromMm) : Vec2f(fromMm, toMm);
  }
  const float t0 = (low - o) / d;
  const float t1 = (high - o) / d;
  return { std::max(fromMm, std::min(t0, t1)), std::min(toMm, std::max(t0, t1)) };
}

/// How far from the axis the centre of a seen brick may lie at these depths, lateral and elevational.
Vec2f besideAxis(const BeamCulling& s, float fromMm, float toMm)
{
  const BeamReach& reach = s.reach;
  if (reach.sight)
  {
    return Vec2f(reach.sight->lateralMm(), reach.sight->elevationalMm());
  }
  const Vec2f brick(s.lateral, s.elevation);
  if (reach.array)
  {
    return reach.array->furthest(fromMm, toMm) * wideningOf(reach) + brick;
  }
  if (reach.table)
  {
    return reach.table->widest(fromMm, toMm) * wideningOf(reach) * reach.share + brick;
  }
  return beamCutSigma * reach.share * Vec2f(reach.beam.lateralSigmaMm, reach.beam.elevationalSigmaMm) + brick;
}

constexpr BrickRow::Span noBricks{ 0, -1 };

/// Narrows [first, last] to the bricks n of a row with |at + n step| <= most, and some more for rounding.
void narrow(float at, float perStep, float most, float& first, float& last)
{
  const float middle = -at * perStep;
  const float half = (most + 1e-3f) * std::fabs(perStep) + 0.01f;
  first = std::max(first, middle - half);
  last = std::min(last, middle + half);
}

/// Which bricks of a row a beam may see: `start` is the centre of its brick 0.
BrickRow::Span clipRow(const Vec3f& start, int firstBrick, int lastBrick, const BeamCulling& s)
{
  float first = float(firstBrick);
  float last = float(lastBrick);
  const Beam& b = s.reach.beam;
  const Vec3f q = start - b.origin;
  const float middleMm = 0.5f * (s.reach.fromMm + s.reach.depthMm);
  narrow(glm::dot(q, b.axis) - middleMm, s.perBrick.x, s.reach.depthMm - middleMm + s.axial, first, last);
  narrow(glm::dot(q, b.lateral), s.perBrick.y, s.besideMm.x, first, last);
  narrow(glm::dot(q, b.elevation), s.perBrick.z, s.besideMm.y, first, last);
  return first <= last ? BrickRow::Span{ int(std::ceil(first)), int(std::floor(last)) } : noBricks;
}

/// The row that is walked through.
class WalkedRow : public BrickRow
{
public:
  WalkedRow(const std::vector<BeamCulling>& beams, std::size_t groupSize, float edgeMm)
    : beams_(beams)
    , cullingOf_(groupSize, nullptr)
    , edgeMm_(edgeMm)
  {
    spans_.assign(groupSize, noBricks);
    for (const BeamCulling& s : beams)
    {
      cullingOf_[s.index] = &s;
    }
  }

  /// From `brick` on, up to the brick `last` along the axis; those at its ends that no beam sees are left out.
  void place(const Vec3i& brick, int axis, int last)
  {
    Vec3i zero = brick;
    zero[axis] = 0;
    const Vec3f start = (Vec3f(zero) + 0.5f) * edgeMm_;
    int from = last + 1;
    int to = brick[axis] - 1;
    for (const BeamCulling& s : beams_)
    {
      Span& span = spans_[s.index];
      span = s.isInLayer ? clipRow(start, brick[axis], last, s) : noBricks;
      from = span.first <= span.last ? std::min(from, span.first) : from;
      to = span.first <= span.last ? std::max(to, span.last) : to;
    }
    for (const BeamCulling& s : beams_)
    {
      Span& span = spans_[s.index];
      span = span.first <= span.last ? Span{ span.first - from, span.last - from } : noBricks;
    }
    first_ = zero;
    first_[axis] = from;
    axis_ = axis;
    count_ = std::max(0, to - from + 1);
  }
  bool sees(std::size_t beam, int n) const override
  {
    const Span& span = spans_[beam];
    return n >= span.first && n <= span.last && sono::sees(*cullingOf_[beam], (Vec3f(brick(n)) + 0.5f) * edgeMm_);
  }

private:
  const std::vector<BeamCulling>& beams_;
  std::vector<const BeamCulling*> cullingOf_;
  float edgeMm_;
};

} // namespace

void forBrickRows(const BrickGrid& grid, const std::vector<BeamReach>& group,
                  const std::function<void(const BrickRow&)>& visit)
{
  const float edge = grid.edgeMm;
  std::vector<BeamCulling> beams = makeBeamCulling(group, edge);
  const int axis = mainAxis(beams);
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  Vec3f low = grid.lowMm;
  Vec3f high = grid.highMm;
  clipBox(beams, low, high);

  for (BeamCulling& s : beams)
  {
    const Beam& b = s.reach.beam;
    const auto perBrick = [&](const Vec3f& direction) {
      const float step = direction[v] * edge;
      return 1.0f / (std::fabs(step) > 1e-6f ? step : 1e-6f);
    };
    s.perBrick = { perBrick(b.axis), perBrick(b.lateral), perBrick(b.elevation) };
  }

  WalkedRow row(beams, group.size(), edge);
  for (int layer = int(std::floor(low[axis] / edge)); float(layer) * edge < high[axis]; ++layer)
  {
    Vec2f first(1e30f);
    Vec2f last(-1e30f);
    for (BeamCulling& s : beams)
    {
      const float lowMm = float(layer) * edge - s.radius[axis];
      const float highMm = float(layer + 1) * edge + s.radius[axis];
      const Vec2f part = clipToSlab(s.reach, axis, lowMm, highMm);
      s.layerToMm = -1.0f;
      if (s.reach.table && part[0] <= part[1])
      {
        s.layerFromMm = part[0] - s.axial;
        s.layerToMm = part[1] + s.axial;
        s.perLayerWidth = 1.0f / s.reach.table->widest(s.layerFromMm, s.layerToMm);
      }
      const Vec2f near = clipToSlab(s.reach, axis, lowMm, highMm, s.axial);
      s.isInLayer = near[0] <= near[1];
      if (s.isInLayer)
      {
        s.besideMm = besideAxis(s, near[0] - s.axial, near[1] + s.axial);
      }
      const Vec3f radius =
        s.reach.table && part[0] <= part[1] ? seenRadius(s.reach, edge, part[0], part[1]) + s.reach.marginMm : s.radius;
      // Between the two ends of the part the axis is straight: its bounds are theirs.
      for (int end = 0; end < 2 && part[0] <= part[1]; ++end)
      {
        const Vec3f p = s.reach.beam.origin + s.reach.beam.axis * part[end];
        first = glm::min(first, Vec2f(p[u] - radius[u], p[v] - radius[v]));
        last = glm::max(last, Vec2f(p[u] + radius[u], p[v] + radius[v]));
      }
    }
    if (last.x < -1e29f)
    {
      continue; // no beam is here
    }
    first = glm::max(first, Vec2f(low[u], low[v]));
    last = glm::min(last, Vec2f(high[u], high[v]));
    const int rowFirst = int(std::floor(first.y / edge));
    const int rowLast = int(std::ceil(last.y / edge)) - 1;
    for (int j = int(std::floor(first.x / edge)); float(j) * edge < last.x; ++j)
    {
      Vec3i brick;
      brick[axis] = layer;
      brick[u] = j;
      brick[v] = rowFirst;
      row.place(brick, v, rowLast);
      if (row.count() > 0)
      {
        visit(row);
      }
    }
  }
}

void forSeenBricks(const BrickGrid& grid, const std::vector<BeamReach>& group,
                   const std::function<void(const Vec3i&, const std::vector<std::size_t>&)>& visit)
{
  std::vector<std::size_t> seeing;
  forBrickRows(grid, group, [&](const BrickRow& row) {
    for (int n = 0; n < row.count(); ++n)
    {
      seeing.clear();
      for (std::size_t beam = 0; beam < group.size(); ++beam)
      {
        if (row.sees(beam, n))
        {
          seeing.push_back(beam);
        }
      }
      if (!seeing.empty())
      {
        visit(row.brick(n), seeing);
      }
    }
  });
}

} // namespace sono
