#include "Scene/NanoConvert.h"

#include "Scene/NanoGridStorage.h"

#include <nanovdb/util/NanoToOpenVDB.h>
#include <nanovdb/util/OpenToNanoVDB.h>

namespace sono {

namespace {

template<class OpenGrid>
NanoGrid convert(OpenGrid& grid)
{
  NanoGrid nano;
  nano.storage = std::make_unique<NanoGrid::Storage>();
  nano.storage->handle = nanovdb::openToNanoVDB(grid);
  return nano;
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
  return convert(grid);
}

NanoGrid nanoFromOpen(openvdb::FloatGrid& grid)
{
  return convert(grid);
}

openvdb::FloatGrid::Ptr openFromNano(const NanoGrid& grid)
{
  return openvdb::gridPtrCast<openvdb::FloatGrid>(nanovdb::NanoToOpenVDB<float>()(*grid.storage->handle.grid<float>()));
}

} // namespace sono
