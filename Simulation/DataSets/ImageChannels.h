#pragma once

#include "DataSets/ChannelImage.h"
#include "DataSets/DataSet.h"
#include "Simulator.h"

#include <cstdint>
#include <vector>

namespace sono {

/// The channels of a picture that are of its pixels; empty (width 0) where none is wanted. Grey is 0 (black) to 1
/// (white), 0 outside the sector; the mask as DataSetImage has it; label the map's id, 0 outside the sector; tissue n +
/// 1 for the n-th tissue of the scene, 0 outside the sector; error the Monte-Carlo error in percent of the intensity.
/// `simulator` has made `input`, `picture` is of it, with labels.
ChannelImage pixelChannels(const std::vector<ImageChannel>& wanted, const ImageInput& input, Simulator& simulator,
                           const ScanPicture& picture, const std::vector<std::uint8_t>& mask);

/// The beam space, a scan line a row, a sample of range a column: grey; envelope and the demodulated signal iq.re,
/// iq.im (RfLines); intensity, the mean of what arrives at the depth that is shown there, 1 at the transducer. Empty
/// (width 0) where it is not wanted.
ChannelImage beamChannels(const std::vector<ImageChannel>& wanted, const ImageInput& input, Simulator& simulator);

} // namespace sono
