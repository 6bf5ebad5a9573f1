#pragma once

#include <openvdb/openvdb.h>

// The virtual functions of OpenVDB's standard grids, which libopenvdb holds. Each file that makes a grid would else
// compile them again, with all that they call in the nodes below: half a minute a file.
#define SONO_IN_LIBOPENVDB(TREE, GRID)                                                                                 \
  extern template void TREE::readTopology(std::istream&, bool);                                                        \
  extern template void TREE::writeTopology(std::ostream&, bool) const;                                                 \
  extern template void TREE::readBuffers(std::istream&, bool);                                                         \
  extern template void TREE::readBuffers(std::istream&, const openvdb::CoordBBox&, bool);                              \
  extern template void TREE::readNonresidentBuffers() const;                                                           \
  extern template void TREE::writeBuffers(std::ostream&, bool) const;                                                  \
  extern template void TREE::print(std::ostream&, int) const;                                                          \
  extern template void TREE::clipUnallocatedNodes();                                                                   \
  extern template openvdb::Index32 TREE::unallocatedLeafCount() const;                                                 \
  extern template bool TREE::evalLeafBoundingBox(openvdb::CoordBBox&) const;                                           \
  extern template bool TREE::evalActiveVoxelBoundingBox(openvdb::CoordBBox&) const;                                    \
  extern template openvdb::Index64 TREE::activeLeafVoxelCount() const;                                                 \
  extern template openvdb::Index64 TREE::inactiveLeafVoxelCount() const;                                               \
  extern template openvdb::Index64 TREE::activeVoxelCount() const;                                                     \
  extern template openvdb::Index64 TREE::inactiveVoxelCount() const;                                                   \
  extern template openvdb::Index64 TREE::activeTileCount() const;                                                      \
  extern template openvdb::Index64 TREE::memUsage() const;                                                             \
  extern template void GRID::pruneGrid(float);                                                                         \
  extern template void GRID::clip(const openvdb::CoordBBox&)

namespace openvdb::OPENVDB_VERSION_NAME {
SONO_IN_LIBOPENVDB(FloatTree, FloatGrid);
SONO_IN_LIBOPENVDB(Int32Tree, Int32Grid);
SONO_IN_LIBOPENVDB(MaskTree, MaskGrid);
}
#undef SONO_IN_LIBOPENVDB
