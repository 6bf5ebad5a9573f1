#include "Scene/NanoConvert.h"

#include "Scene/NanoGridStorage.h"

#define NANOVDB_USE_TBB
#include <nanovdb/util/NanoToOpenVDB.h>
#include <nanovdb/util/OpenToNanoVDB.h>

namespace sono {

namespace {

NanoGrid wrap(nanovdb::GridHandle<nanovdb::HostBuffer> handle)
{
  NanoGrid nano;
  nano.storage = std::make_unique<NanoGrid::Storage>();
  nano.storage->handle = std::move(handle);
  return nano;
}

template<class Build>
openvdb::GridBase::Ptr convertBack(const NanoGrid& grid)
{
  return nanovdb::NanoToOpenVDB<Build>()(*grid.storage->handle.grid<Build>());
}

} // namespace

NanoGrid::NanoGrid() = default;
NanoGrid::~NanoGrid() = default;
NanoGrid::NanoGrid(NanoGrid&&) noexcept = default;
NanoGrid& NanoGrid::operator=(NanoGrid&&) noexcept = default;

std::size_t NanoGrid::bytes() const
{
  return storage ? storage->handle.size() : 0;
}

NanoGrid nanoFromOpen(openvdb::Int32Grid& grid)
{
  return wrap(nanovdb::openToNanoVDB(grid));
}

NanoGrid nanoFromOpen(openvdb::MaskGrid& grid)
{
  return wrap(nanovdb::openToNanoVDB(grid));
}

NanoGrid compactNanoFromOpen(openvdb::FloatGrid& grid)
{
  return wrap(nanovdb::openToNanoVDB<nanovdb::HostBuffer, openvdb::FloatTree, nanovdb::Fp8>(grid));
}

openvdb::GridBase::Ptr openFromNano(const NanoGrid& grid)
{
  switch (grid.storage->handle.gridType())
  {
    case nanovdb::GridType::Int32:
      return convertBack<std::int32_t>(grid);
    case nanovdb::GridType::Mask:
      return convertBack<nanovdb::ValueMask>(grid);
    default:
      return convertBack<nanovdb::Fp8>(grid);
  }
}

} // namespace sono
