#pragma once

#include <openvdb/openvdb.h>

// OpenVDB's standard grids, which libopenvdb holds. Each file that makes a grid would else compile their virtual
// functions again, with all that they call in the nodes below: half a minute a file.
#define SONO_IN_LIBOPENVDB(GRID)                                                                                       \
  extern template class tree::Tree<GRID::TreeType::RootNodeType>;                                                      \
  extern template class Grid<GRID::TreeType>

namespace openvdb::OPENVDB_VERSION_NAME {
SONO_IN_LIBOPENVDB(FloatGrid);
SONO_IN_LIBOPENVDB(Int32Grid);
SONO_IN_LIBOPENVDB(MaskGrid);
}
#undef SONO_IN_LIBOPENVDB

namespace sono {

constexpr int leafEdge = 8; ///< of the grids' leaf nodes

} // namespace sono
