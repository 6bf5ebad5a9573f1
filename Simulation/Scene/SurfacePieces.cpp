#include "Scene/SurfacePieces.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sono {

namespace {

constexpr int widest = 24; // voxels to each side of a column
constexpr std::array<int, 9> windows{ 1, 2, 3, 4, 6, 8, 12, 16, widest };
constexpr float planeResidual = 0.60f; // voxels: half a voxel is a step's rounding
constexpr float bentResidual = 0.66f;
constexpr int mostStep = 2;           // voxels from a column's step to its neighbour's
constexpr float leastFacing = 0.5f;   // of a normal along the column: some axis has 0.577
constexpr float certainlyNot = 0.25f; // the same of a coarse normal

/// A least-squares fit of a quadratic to the heights of a window, every column present: with weights that depend on the
/// distance alone the normal equations fall apart.
struct WindowFit
{
  std::vector<float> weight; // (2 R + 1)^2, round, smooth to its rim so that a terrace's harmonics are not let through
  double s0 = 0.0, s2 = 0.0, s4 = 0.0, s22 = 0.0;

  explicit WindowFit(int radius)
  {
    for (int j = -radius; j <= radius; ++j)
    {
      for (int i = -radius; i <= radius; ++i)
      {
        const double q = 1.0 - double(i * i + j * j) / ((radius + 1.0) * (radius + 1.0));
        const double w = q > 0.0 ? q * q * q * q : 0.0;
        weight.push_back(float(w));
        s0 += w;
        s2 += w * i * i;
        s4 += w * i * i * i * i;
        s22 += w * i * i * j * j;
      }
    }
  }
};

const WindowFit& windowFit(int radius)
{
  static const std::vector<WindowFit> fits = [] {
    std::vector<WindowFit> made;
    for (int r = 0; r <= widest; ++r)
    {
      made.emplace_back(r);
    }
    return made;
  }();
  return fits[std::size_t(radius)];
}

/// c0 + c1 i + c2 j + c3 i^2 + c4 j^2 + c5 i j, voxels.
struct Quadratic
{
  float c0, c1, c2, c3, c4, c5;
  float at(int i, int j) const { return c0 + c1 * i + c2 * j + c3 * i * i + c4 * j * j + c5 * i * j; }
};

/// Steps of the columns around a face, relative to its own: how many voxels along the axis they lie further.
class StepMap
{
public:
  StepMap(const std::uint8_t* tissues, const Vec3i& size)
    : tissues_(tissues)
    , size_(size)
    , pitch_{ 1, size.x, std::ptrdiff_t(size.x) * size.y }
  {
  }

  std::uint8_t at(const Vec3i& v) const { return tissues_[v.x + pitch_[1] * v.y + pitch_[2] * v.z]; }
  bool contains(const Vec3i& v) const
  {
    return unsigned(v.x) < unsigned(size_.x) && unsigned(v.y) < unsigned(size_.y) && unsigned(v.z) < unsigned(size_.z);
  }

  /// Fills the rings [first, last] around the face above `voxel`, those before them being filled; whether each column
  /// has a step from the same tissue to the same other one.
  bool gather(const Vec3i& voxel, int axis, int first, int last)
  {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const std::uint8_t below = at(voxel);
    Vec3i next = voxel;
    ++next[axis];
    const std::uint8_t above = at(next);
    const std::ptrdiff_t base = voxel.x + pitch_[1] * voxel.y + pitch_[2] * voxel.z;
    for (int r = first; r <= last; ++r)
    {
      if (voxel[u] - r < 0 || voxel[u] + r >= size_[u] || voxel[v] - r < 0 || voxel[v] + r >= size_[v])
      {
        return false;
      }
      const auto find = [&](int i, int j) {
        const int from = step(i == r ? r - 1 : (i == -r ? 1 - r : i), j == r ? r - 1 : (j == -r ? 1 - r : j));
        for (int n = 0; n <= 2 * mostStep; ++n)
        {
          const int h = from + ((n & 1) ? (n + 1) / 2 : -n / 2);
          const int place = voxel[axis] + h;
          if (place < 0 || place + 1 >= size_[axis])
          {
            continue;
          }
          const std::uint8_t* t = tissues_ + base + i * pitch_[u] + j * pitch_[v] + h * pitch_[axis];
          if (t[0] == below && t[pitch_[axis]] == above)
          {
            step(i, j) = std::int16_t(h);
            return true;
          }
        }
        return false;
      };
      for (int n = -r; n <= r; ++n)
      {
        if (!find(n, -r) || !find(n, r) || (n > -r && n < r && (!find(-r, n) || !find(r, n))))
        {
          return false;
        }
      }
    }
    return true;
  }

  /// The quadratic, and the plane.
  Quadratic fit(int radius, Quadratic& plane) const
  {
    const WindowFit& f = windowFit(radius);
    double h0 = 0.0, hi = 0.0, hj = 0.0, hii = 0.0, hjj = 0.0, hij = 0.0;
    const float* w = f.weight.data();
    for (int j = -radius; j <= radius; ++j)
    {
      float r0 = 0.0f, r1 = 0.0f, r2 = 0.0f; // exact sums of a row come first
      for (int i = -radius; i <= radius; ++i)
      {
        const float wh = *w++ * float(step(i, j));
        r0 += wh;
        r1 += wh * float(i);
        r2 += wh * float(i * i);
      }
      h0 += r0;
      hi += r1;
      hii += r2;
      hj += r0 * j;
      hij += r1 * j;
      hjj += r0 * j * j;
    }
    Quadratic q{};
    plane = { float(h0 / f.s0), float(hi / f.s2), float(hj / f.s2), 0.0f, 0.0f, 0.0f };
    q.c1 = float(hi / f.s2);
    q.c2 = float(hj / f.s2);
    q.c5 = float(hij / f.s22);
    const double minus = (hii - hjj) / (f.s4 - f.s22);
    const double both = f.s4 + f.s22;
    const double plus = ((hii + hjj) * f.s0 - 2.0 * f.s2 * h0) / (both * f.s0 - 2.0 * f.s2 * f.s2);
    q.c0 = float((h0 - f.s2 * plus) / f.s0);
    q.c3 = float(0.5 * (plus + minus));
    q.c4 = float(0.5 * (plus - minus));
    return q;
  }

  /// Largest distance from the fit, but for the rim, which hardly counts in it.
  float residual(const Quadratic& q, int radius) const
  {
    float largest = 0.0f;
    for (int j = -radius; j <= radius; ++j)
    {
      for (int i = -radius; i <= radius; ++i)
      {
        if (4 * (i * i + j * j) <= 3 * radius * radius)
        {
          largest = std::max(largest, std::fabs(float(step(i, j)) - q.at(i, j)));
        }
      }
    }
    return largest;
  }

  /// The fit in the widest window that agrees with the labels, a plane where one does; false where none does.
  bool smoothest(const Vec3i& voxel, int axis, Quadratic& out)
  {
    step(0, 0) = 0;
    const auto agrees = [&](int radius) {
      Quadratic plane{};
      const Quadratic bent = fit(radius, plane);
      const bool isPlane = residual(plane, radius) <= planeResidual;
      if (isPlane || residual(bent, radius) <= bentResidual)
      {
        out = isPlane ? plane : bent;
        return true;
      }
      return false;
    };
    std::size_t w = 0;
    for (int gathered = 0; w < windows.size() && gather(voxel, axis, gathered + 1, windows[w]); ++w)
    {
      gathered = windows[w];
    }
    while (w > 0)
    {
      if (agrees(windows[--w]))
      {
        return true;
      }
    }
    return false;
  }

  /// From the mean place of the tissue below to that of the one above, in the 5 x 5 x 4 voxels around a face; in
  /// voxels, any length.
  Vec3f coarseNormal(const Vec3i& voxel, int axis) const
  {
    Vec3i low = voxel - 2;
    Vec3i high = voxel + 2;
    low[axis] = voxel[axis] - 1;
    Vec3i next = voxel;
    ++next[axis];
    const std::uint8_t below = at(voxel);
    const std::uint8_t above = at(next);
    Vec3f middle(voxel);
    middle[axis] += 0.5f;
    low = glm::max(low, Vec3i(0));
    high = glm::min(high, size_ - 1);
    Vec3f sum(0.0f);
    for (int k = low.z; k <= high.z; ++k)
    {
      for (int j = low.y; j <= high.y; ++j)
      {
        for (int i = low.x; i <= high.x; ++i)
        {
          const std::uint8_t t = at(Vec3i(i, j, k));
          const float sign = t == above ? 1.0f : (t == below ? -1.0f : 0.0f);
          sum += sign * (Vec3f(i, j, k) - middle);
        }
      }
    }
    return sum;
  }

private:
  std::int16_t& step(int i, int j) { return steps_[std::size_t(i + widest + (2 * widest + 1) * (j + widest))]; }
  std::int16_t step(int i, int j) const { return steps_[std::size_t(i + widest + (2 * widest + 1) * (j + widest))]; }

  const std::uint8_t* tissues_;
  Vec3i size_;
  std::ptrdiff_t pitch_[3];
  std::array<std::int16_t, std::size_t(2 * widest + 1) * (2 * widest + 1)> steps_{};
};

/// How much of a surface the columns along an axis stand for. Each axis' columns cover all of it, evenly but for a
/// stretch by 1 / facing; those that see it best share it, with smooth weights.
float shareOf(const Vec3f& normal, int axis)
{
  const auto part = [](float facing) {
    const float q = std::max(0.0f, std::fabs(facing) - leastFacing);
    return q * q;
  };
  return part(normal[axis]) / (part(normal.x) + part(normal.y) + part(normal.z));
}

/// False where another axis' columns stand for all of the surface.
bool makePiece(StepMap& map, const Vec3i& voxel, int axis, const Vec3f& spacing, SurfacePiece& piece)
{
  const Vec3f coarse = map.coarseNormal(voxel, axis);
  const float length = glm::length(coarse);
  const bool isThin = !(length > 1e-3f) || coarse[axis] <= 0.0f;
  if (!isThin && coarse[axis] < certainlyNot * length)
  {
    return false;
  }
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  Quadratic q{};
  if (!map.smoothest(voxel, axis, q) && !isThin)
  {
    q.c1 = -coarse[u] / coarse[axis];
    q.c2 = -coarse[v] / coarse[axis];
  }
  Vec3f normal(0.0f); // in voxels, where columns are what covers the surface
  normal[axis] = 1.0f;
  normal[u] = -q.c1;
  normal[v] = -q.c2;
  piece.share = shareOf(glm::normalize(normal), axis);
  if (!(piece.share > 0.0f))
  {
    return false;
  }
  piece.positionMm = (Vec3f(voxel) + 0.5f) * spacing;
  piece.positionMm[axis] += (0.5f + q.c0) * spacing[axis];
  piece.slopeU = q.c1 * spacing[axis] / spacing[u];
  piece.slopeV = q.c2 * spacing[axis] / spacing[v];
  piece.bendUU = 2.0f * q.c3 * spacing[axis] / (spacing[u] * spacing[u]);
  piece.bendUV = q.c5 * spacing[axis] / (spacing[u] * spacing[v]);
  piece.bendVV = 2.0f * q.c4 * spacing[axis] / (spacing[v] * spacing[v]);
  piece.axis = std::uint8_t(axis);
  piece.below = map.at(voxel);
  Vec3i next = voxel;
  ++next[axis];
  piece.above = map.at(next);
  piece.voxel = voxel;
  return true;
}

} // namespace

SurfacePieces::SurfacePieces(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm)
  : tissues_(tissues)
  , size_(size)
  , spacingMm_(spacingMm)
  , sizeMm_(Vec3d(size) * spacingMm)
  , edgeMm_(float(6.0 * std::max({ spacingMm.x, spacingMm.y, spacingMm.z })))
  , bricks_(Vec3i(glm::floor(sizeMm_ / edgeMm_)) + 1)
  , made_(std::size_t(bricks_.x) * std::size_t(bricks_.y) * std::size_t(bricks_.z))
{
}

SurfacePieces::~SurfacePieces()
{
  for (const auto& brick : made_)
  {
    delete brick.load();
  }
}

const std::vector<SurfacePiece>& SurfacePieces::brick(const Vec3i& brick) const
{
  static const std::vector<SurfacePiece> none;
  if (glm::any(glm::lessThan(brick, Vec3i(0))) || glm::any(glm::greaterThanEqual(brick, bricks_)))
  {
    return none;
  }
  auto& place = made_[std::size_t(brick.x) +
                      std::size_t(bricks_.x) * (std::size_t(brick.y) + std::size_t(bricks_.y) * std::size_t(brick.z))];
  const std::vector<SurfacePiece>* there = place.load(std::memory_order_acquire);
  if (!there)
  {
    // Of two threads that make the same brick one is too late.
    auto mine = std::make_unique<const std::vector<SurfacePiece>>(make(brick));
    if (place.compare_exchange_strong(there, mine.get(), std::memory_order_acq_rel))
    {
      there = mine.release();
    }
  }
  return *there;
}

std::vector<SurfacePiece> SurfacePieces::make(const Vec3i& brick) const
{
  std::vector<SurfacePiece> pieces;
  StepMap map(tissues_, size_);
  const Vec3f low = Vec3f(brick) * edgeMm_ / spacingMm_ - 0.5f;
  const Vec3f high = Vec3f(brick + 1) * edgeMm_ / spacingMm_ - 0.5f;
  const Vec3i first = glm::max(Vec3i(glm::ceil(low)), Vec3i(0));
  const Vec3i last = glm::min(Vec3i(glm::ceil(high)), size_);
  for (int k = first.z; k < last.z; ++k)
  {
    for (int j = first.y; j < last.y; ++j)
    {
      for (int i = first.x; i < last.x; ++i)
      {
        const Vec3i voxel(i, j, k);
        for (int axis = 0; axis < 3; ++axis)
        {
          Vec3i next = voxel;
          ++next[axis];
          SurfacePiece piece{};
          if (next[axis] < size_[axis] && map.at(voxel) != map.at(next) &&
              makePiece(map, voxel, axis, spacingMm_, piece))
          {
            pieces.push_back(piece);
          }
        }
      }
    }
  }
  pieces.shrink_to_fit();
  return pieces;
}

} // namespace sono
