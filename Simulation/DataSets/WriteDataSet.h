#pragma once

#include "Core/Progress.h"
#include "DataSets/DataSetImager.h"

#include <functional>
#include <string>

namespace sono {

/// How far a process has come with its images.
struct DataSetTally
{
  std::int64_t total = 0;
  std::int64_t done = 0; ///< those that were there before, too
  std::int64_t made = 0;
  double seconds = 0.0; ///< for those
};

/// Writes a process's share of a data set into a folder, those images that are not there yet. Each file is written
/// whole or not at all, the JSON file of an image after its picture and its mask; an image is there where its JSON file
/// is. So a process that was killed, however, is started again with the same arguments, and goes on; the folder is then
/// the same, to the byte, as if it had not been. So it is however many processes share the work.
///
/// A folder that nnU-Net takes: imagesTr and imagesTs with CASE_0000.png, labelsTr and labelsTs with CASE.png, info
/// with CASE.json, dataset.json and splits_final.json. One that MONAI takes: images, labels and info, and the data list
/// dataset.json with training, validation and test. Beside them dataset_source.json: the file that declared it all.
/// Where that asks for channels, OpenEXR files: channels/CASE.exr, as large as the picture, and beam/CASE.exr, lines x
/// samples (see ImageChannels.h), which `encode` makes.
///
/// `workers` threads make images beside each other, 0: as many as suit the device (imageWorkers). `tell` hears after
/// each image, on the calling thread. Throws Error as DataSetImager, where the folder holds another
/// data set, where a file cannot be written, and for channels without `encode`; Aborted.
DataSetTally writeDataSet(DataSetImager& imager, const std::string& folder, const DataSetShare& share = {},
                          const Progress& progress = {}, const std::function<void(const DataSetTally&)>& tell = {},
                          int workers = 0, const EncodeExr& encode = {});

} // namespace sono
