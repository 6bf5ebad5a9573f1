#include "Scene/SurfacePieces.h"

#include "Core/ParallelFor.h"
#include "Core/Simd.h"
#include "Scene/FitPiece.h"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace sono {

namespace {

using namespace stepfit;

constexpr float certainlyNot = 0.25f; // facing of a coarse normal along the column: of the piece's less than 0.5
const SurfacePiece noPiece{};         // stands where columns of another axis do

SONO_SIMD_CLONES __attribute__((flatten)) SurfacePiece fitByVectors(const std::uint8_t* tissues, const Vec3i& size,
                                                                    const Vec3f& spacing, const SurfaceFace& face)
{
  StepMap map(tissues, size, hostWindows());
  return fitPiece(map, spacing, face);
}

std::uint64_t nextId()
{
  static std::atomic<std::uint64_t> last{ 0 };
  return ++last;
}

} // namespace

SurfacePieces::SurfacePieces(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm)
  : id_(nextId())
  , tissues_(tissues)
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
    piece = keep(fitByVectors(tissues_, size_, spacingMm_, there.faces[face]), place);
  }
  return piece == &noPiece ? nullptr : piece;
}

/// What is there afterwards: of two threads that make the same piece one is too late.
const SurfacePiece* SurfacePieces::keep(const SurfacePiece& made, std::atomic<const SurfacePiece*>& place) const
{
  auto mine = made.share > 0.0f ? std::make_unique<SurfacePiece>(made) : nullptr;
  const SurfacePiece* piece = nullptr;
  if (place.compare_exchange_strong(piece, mine ? mine.get() : &noPiece, std::memory_order_acq_rel))
  {
    piece = mine ? mine.release() : &noPiece;
  }
  return piece;
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
  std::vector<SurfacePiece> pieces;
  for (const Vec3i& brick : bricksOf(block))
  {
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

std::vector<Vec3i> SurfacePieces::bricksOf(int block) const
{
  const Vec3i first =
    blockBricks * Vec3i(block % blocks_.x, block / blocks_.x % blocks_.y, block / blocks_.x / blocks_.y);
  const Vec3i end = glm::min(first + blockBricks, bricks_);
  std::vector<Vec3i> bricks;
  for (int k = first.z; k < end.z; ++k)
  {
    for (int j = first.y; j < end.y; ++j)
    {
      for (int i = first.x; i < end.x; ++i)
      {
        bricks.emplace_back(i, j, k);
      }
    }
  }
  return bricks;
}

void SurfacePieces::makeBlocks(const std::vector<int>& blocks, const Fit& fit) const
{
  std::vector<int> missing;
  std::copy_if(blocks.begin(), blocks.end(), std::back_inserter(missing),
               [&](int block) { return !whole_[std::size_t(block)].load(std::memory_order_acquire); });
  if (missing.empty())
  {
    return;
  }
  if (fit)
  {
    fitBlocks(missing, fit);
  }
  else
  {
    parallelFor(int(missing.size()), {}, [&](int n) {
      forBricksOf(missing[std::size_t(n)], [](const Vec3i&, const std::vector<SurfacePiece>&) {});
    });
  }
  for (const int block : missing)
  {
    whole_[std::size_t(block)].store(true, std::memory_order_release);
  }
}

void SurfacePieces::fitBlocks(const std::vector<int>& blocks, const Fit& fit) const
{
  std::vector<std::size_t> first(blocks.size() + 1, 0); // face of each block
  parallelFor(int(blocks.size()), {}, [&](int n) {
    for (const Vec3i& brick : bricksOf(blocks[std::size_t(n)]))
    {
      first[std::size_t(n) + 1] += faces(brick).size();
    }
  });
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<Face> all(first.back());
  parallelFor(int(blocks.size()), {}, [&](int n) {
    auto to = all.begin() + std::ptrdiff_t(first[std::size_t(n)]);
    for (const Vec3i& brick : bricksOf(blocks[std::size_t(n)]))
    {
      to = std::copy(faces(brick).begin(), faces(brick).end(), to);
    }
  });
  const std::vector<SurfacePiece> made = fit(all);
  parallelFor(int(blocks.size()), {}, [&](int n) {
    std::size_t next = first[std::size_t(n)];
    for (const Vec3i& brick : bricksOf(blocks[std::size_t(n)]))
    {
      for (std::size_t face = 0; face < faces(brick).size(); ++face)
      {
        keep(made[next++], at(brick)->pieces[face]);
      }
    }
  });
}

std::vector<SurfacePieces::Face> SurfacePieces::findFaces(const Vec3i& brick) const
{
  std::vector<Face> faces;
  const StepMap map(tissues_, size_, hostWindows());
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
