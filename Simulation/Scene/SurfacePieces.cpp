#include "Scene/SurfacePieces.h"

#include "Core/Policy.h"
#include "Core/Simd.h"
#include "Scene/FindFace.h"
#include "Scene/FitPiece.h"

#include <algorithm>

namespace sono {

namespace {

using namespace stepfit;

const SurfacePiece noPiece{}; // stands where columns of another axis do

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
  , coarseApart_(glm::max(Vec3i(float(interactivePieceMm) / spacingMm_ + 1e-3f), Vec3i(1)))
  , sizeMm_(Vec3d(size) * spacingMm)
  , edgeMm_(float(6.0 * std::max({ spacingMm.x, spacingMm.y, spacingMm.z })))
  , bricks_(Vec3i(glm::floor(sizeMm_ / edgeMm_)) + 1)
  , blocks_((bricks_ - 1) / blockBricks + 1)
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

/// Null outside of the volume.
std::atomic<const SurfacePieces::Brick*>* SurfacePieces::placeOf(const Vec3i& brick) const
{
  if (glm::any(glm::lessThan(brick, Vec3i(0))) || glm::any(glm::greaterThanEqual(brick, bricks_)))
  {
    return nullptr;
  }
  return &made_[std::size_t(brick.x) +
                std::size_t(bricks_.x) * (std::size_t(brick.y) + std::size_t(bricks_.y) * std::size_t(brick.z))];
}

const SurfacePieces::Brick* SurfacePieces::at(const Vec3i& brick) const
{
  auto* const place = placeOf(brick);
  if (!place)
  {
    return nullptr;
  }
  const Brick* there = place->load(std::memory_order_acquire);
  if (!there)
  {
    // Of two threads that make the same brick one is too late.
    auto mine = std::make_unique<Brick>();
    mine->faces = findFaces(brick);
    const auto coarseEnd = std::stable_partition(mine->faces.begin(), mine->faces.end(),
                                                 [this](const Face& face) { return isCoarse(face); });
    mine->coarseCount = std::size_t(coarseEnd - mine->faces.begin());
    mine->pieces = std::make_unique<std::atomic<const SurfacePiece*>[]>(mine->faces.size());
    if (place->compare_exchange_strong(there, mine.get(), std::memory_order_acq_rel))
    {
      there = mine.release();
    }
  }
  return there;
}

void SurfacePieces::prefetch(const Vec3i& brick) const
{
  constexpr int linesAhead = 4; // what follows is read in turn, which a processor foresees
  const auto* const place = placeOf(brick);
  const Brick* const there = place ? place->load(std::memory_order_acquire) : nullptr;
  if (there && !there->faces.empty())
  {
    const char* const faces = reinterpret_cast<const char*>(there->faces.data());
    for (int line = 0; line < linesAhead; ++line)
    {
      __builtin_prefetch(faces + 64 * line);
    }
  }
}

const std::vector<SurfacePieces::Face>& SurfacePieces::faces(const Vec3i& brick) const
{
  static const std::vector<Face> none;
  const Brick* there = at(brick);
  return there ? there->faces : none;
}

std::size_t SurfacePieces::coarseCount(const Vec3i& brick) const
{
  const Brick* there = at(brick);
  return there ? there->coarseCount : 0;
}

const SurfacePiece* SurfacePieces::piece(const Vec3i& brick, std::size_t face) const
{
  const Brick& there = *at(brick);
  auto& place = there.pieces[face];
  const SurfacePiece* piece = place.load(std::memory_order_acquire);
  if (!piece)
  {
    // Of two threads that make the same piece one is too late.
    const SurfacePiece made = fitByVectors(tissues_, size_, spacingMm_, there.faces[face]);
    auto mine = made.share > 0.0f ? std::make_unique<SurfacePiece>(made) : nullptr;
    if (place.compare_exchange_strong(piece, mine ? mine.get() : &noPiece, std::memory_order_acq_rel))
    {
      piece = mine ? mine.release() : &noPiece;
    }
  }
  return piece == &noPiece ? nullptr : piece;
}

void SurfacePieces::fitCoarse(const VoxelBox& box, const Progress& progress) const
{
  const auto brickAt = [&](const Vec3i& voxel) {
    return glm::clamp(Vec3i((Vec3f(voxel) + 0.5f) * spacingMm_ / edgeMm_), Vec3i(0), bricks_ - 1);
  };
  const Vec3i first = brickAt(box.first);
  const Vec3i last = brickAt(box.last - 1);
  const Vec3i count = last - first + 1;
  const int all = count.x * count.y * count.z;
  for (int b = 0; b < all; ++b)
  {
    const Vec3i brick = first + Vec3i(b % count.x, b / count.x % count.y, b / count.x / count.y);
    const std::size_t faces = coarseCount(brick);
    for (std::size_t face = 0; face < faces; ++face)
    {
      if (progress && !progress(double(b) / all))
      {
        return;
      }
      piece(brick, face);
    }
  }
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

Vec3i SurfacePieces::firstBrick(int block) const
{
  return blockBricks * Vec3i(block % blocks_.x, block / blocks_.x % blocks_.y, block / blocks_.x / blocks_.y);
}

std::vector<SurfacePieces::Face> SurfacePieces::findFaces(const Vec3i& brick) const
{
  std::vector<Face> faces;
  const TissueVolume volume{ tissues_, size_ };
  const BrickVoxels voxels(brick, brick + 1, edgeMm_, spacingMm_, size_);
  for (int k = voxels.first.z; k < voxels.last.z; ++k)
  {
    for (int j = voxels.first.y; j < voxels.last.y; ++j)
    {
      for (int i = voxels.first.x; i < voxels.last.x; ++i)
      {
        for (int axis = 0; axis < 3; ++axis)
        {
          Face face;
          if (findFace(volume, spacingMm_, Vec3i(i, j, k), axis, face))
          {
            faces.push_back(face);
          }
        }
      }
    }
  }
  faces.shrink_to_fit();
  return faces;
}

bool SurfacePieces::isCoarse(const Face& face) const
{
  const auto isOne = [&](int axis) { return face.axis == axis || face.voxel[axis] % coarseApart_[axis] == 0; };
  return isOne(0) && isOne(1) && isOne(2);
}

} // namespace sono
