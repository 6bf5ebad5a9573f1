#pragma once

#include "Labels/LabelVolume.h"
#include "Phantoms/ThoraxParameters.h"

namespace sono {

/// What is wrong with a drawn body; all 0 in a valid one.
struct ThoraxFaults
{
  int open = 0; ///< voxel faces between a chamber and what is neither its wall, its valve, nor its neighbour behind one
  int apart = 0; ///< chambers of which more than 0.5 % do not hang together, by faces, with their largest part; grooves
                 ///< behind leaflets and muscles leave single voxels
  int volumes =
    0; ///< chambers more than 5 % off the volume that was asked for; after the end of diastole left
       ///< ventricles that ejected 10 % of it more or less than phase and fraction say: as the
       ///< leaflets close, up to 8 % come to the ventricle that stood between them and counted as the atrium's

  bool none() const { return open == 0 && apart == 0 && volumes == 0; }
};

/// Looks at the voxels alone. @param labels of makeThoraxPhantom, at most 2 mm: thinner walls cannot be seen in coarser
/// voxels. Volumes count what the cavity's blood fills, as ThoraxParameters does.
ThoraxFaults checkThorax(const LabelVolume& labels, const ThoraxParameters& parameters);

} // namespace sono
