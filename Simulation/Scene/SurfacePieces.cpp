#include "Scene/SurfacePieces.h"

#include "Core/Simd.h"
#include "Scene/StepMap.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sono {

namespace {

using namespace stepfit;

constexpr float leastFacing = 0.5f;   // of a normal along the column: some axis has 0.577
constexpr float certainlyNot = 0.25f; // the same of a coarse normal
const SurfacePiece noPiece{};         // stands where columns of another axis do

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
SONO_SIMD_CLONES __attribute__((flatten)) bool makePiece(const std::uint8_t* tissues, const Vec3i& size,
                                                         const Vec3f& spacing, const SurfacePieces::Face& face,
                                                         SurfacePiece& piece)
{
  StepMap map(tissues, size);
  const Vec3i& voxel = face.voxel;
  const int axis = face.axis;
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  Quadratic q{};
  if (!map.smoothest(voxel, axis, spacing, q) && face.roughNormal != Vec3f(0.0f))
  {
    // In voxels.
    q.c1 = -face.roughNormal[u] * spacing[u] / (face.roughNormal[axis] * spacing[axis]);
    q.c2 = -face.roughNormal[v] * spacing[v] / (face.roughNormal[axis] * spacing[axis]);
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
  piece.below = face.below;
  piece.above = face.above;
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
  , blocks_((bricks_ - 1) / blockBricks + 1)
  , made_(std::size_t(bricks_.x) * std::size_t(bricks_.y) * std::size_t(bricks_.z))
  , whole_(std::size_t(blockCount()))
{
}

SurfacePieces::~SurfacePieces()
{
  for (const auto& brick : made_)
  {
    delete brick.load();
  }
}

SurfacePieces::Brick::~Brick()
{
  for (std::size_t n = 0; n < faces.size(); ++n)
  {
    const SurfacePiece* piece = pieces[n].load();
    if (piece != &noPiece)
    {
      delete piece;
    }
  }
}

const SurfacePieces::Brick* SurfacePieces::at(const Vec3i& brick) const
{
  if (glm::any(glm::lessThan(brick, Vec3i(0))) || glm::any(glm::greaterThanEqual(brick, bricks_)))
  {
    return nullptr;
  }
  auto& place = made_[std::size_t(brick.x) +
                      std::size_t(bricks_.x) * (std::size_t(brick.y) + std::size_t(bricks_.y) * std::size_t(brick.z))];
  const Brick* there = place.load(std::memory_order_acquire);
  if (!there)
  {
    // Of two threads that make the same brick one is too late.
    auto mine = std::make_unique<Brick>();
    mine->faces = findFaces(brick);
    mine->pieces = std::make_unique<std::atomic<const SurfacePiece*>[]>(mine->faces.size());
    if (place.compare_exchange_strong(there, mine.get(), std::memory_order_acq_rel))
    {
      there = mine.release();
    }
  }
  return there;
}

const std::vector<SurfacePieces::Face>& SurfacePieces::faces(const Vec3i& brick) const
{
  static const std::vector<Face> none;
  const Brick* there = at(brick);
  return there ? there->faces : none;
}

const SurfacePiece* SurfacePieces::piece(const Vec3i& brick, std::size_t face) const
{
  const Brick& there = *at(brick);
  auto& place = there.pieces[face];
  const SurfacePiece* piece = place.load(std::memory_order_acquire);
  if (!piece)
  {
    auto mine = std::make_unique<SurfacePiece>();
    const bool counts = makePiece(tissues_, size_, spacingMm_, there.faces[face], *mine);
    const SurfacePiece* made = counts ? mine.get() : &noPiece;
    if (place.compare_exchange_strong(piece, made, std::memory_order_acq_rel))
    {
      piece = counts ? mine.release() : &noPiece;
    }
  }
  return piece == &noPiece ? nullptr : piece;
}

Vec3f SurfacePieces::middleMm(const Face& face) const
{
  Vec3f middle = (Vec3f(face.voxel) + 0.5f) * spacingMm_;
  middle[face.axis] += 0.5f * spacingMm_[face.axis];
  return middle;
}

int SurfacePieces::blockOf(const Vec3i& brick) const
{
  if (glm::any(glm::lessThan(brick, Vec3i(0))) || glm::any(glm::greaterThanEqual(brick, bricks_)))
  {
    return -1;
  }
  const Vec3i block = brick / blockBricks;
  return block.x + blocks_.x * (block.y + blocks_.y * block.z);
}

void SurfacePieces::forBricksOf(
  int block, const std::function<void(const Vec3i& brick, const std::vector<SurfacePiece>&)>& visit) const
{
  const Vec3i first =
    blockBricks * Vec3i(block % blocks_.x, block / blocks_.x % blocks_.y, block / blocks_.x / blocks_.y);
  std::vector<SurfacePiece> pieces;
  for (int n = 0; n < blockBricks * blockBricks * blockBricks; ++n)
  {
    const Vec3i brick = first + Vec3i(n % blockBricks, n / blockBricks % blockBricks, n / blockBricks / blockBricks);
    pieces.clear();
    for (std::size_t face = 0; face < faces(brick).size(); ++face)
    {
      if (const SurfacePiece* piece = this->piece(brick, face))
      {
        pieces.push_back(*piece);
      }
    }
    if (!pieces.empty())
    {
      visit(brick, pieces);
    }
  }
}

void SurfacePieces::makeBlock(int block) const
{
  std::atomic<bool>& isWhole = whole_[std::size_t(block)];
  if (!isWhole.load(std::memory_order_relaxed))
  {
    forBricksOf(block, [](const Vec3i&, const std::vector<SurfacePiece>&) {});
    isWhole.store(true, std::memory_order_relaxed);
  }
}

std::vector<SurfacePieces::Face> SurfacePieces::findFaces(const Vec3i& brick) const
{
  std::vector<Face> faces;
  const StepMap map(tissues_, size_);
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
          if (next[axis] >= size_[axis] || map.at(voxel) == map.at(next))
          {
            continue;
          }
          const Vec3f coarse = map.coarseNormal(voxel, axis);
          const float length = glm::length(coarse);
          const bool isThin = !(length > 1e-3f) || coarse[axis] <= 0.0f;
          if (isThin || coarse[axis] >= certainlyNot * length)
          {
            faces.push_back({ voxel, isThin ? Vec3f(0.0f) : glm::normalize(coarse / spacingMm_), std::uint8_t(axis),
                              map.at(voxel), map.at(next) });
          }
        }
      }
    }
  }
  faces.shrink_to_fit();
  return faces;
}

} // namespace sono
