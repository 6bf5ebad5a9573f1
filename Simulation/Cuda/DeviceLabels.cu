#include "Cuda/DeviceLabels.cuh"

namespace sono {

namespace {

constexpr int threads = 256;

/// A block takes a row.
__global__ void sliceRows(const LabelRow* rows, int width, int rowsPerImage, const std::uint16_t* voxels, Vec3i size,
                          const std::uint8_t* mask, PlaneScan scan, const float* offsetMm, std::uint16_t* labels)
{
  const LabelRow row = rows[blockIdx.x];
  const float x = scan.beams.axialFromCentre(scan.axialMm(int(blockIdx.x) % rowsPerImage));
  const float* ofImage =
    offsetMm ? offsetMm + std::size_t(int(blockIdx.x) / rowsPerImage) * scan.valueCount() : nullptr;
  const std::uint8_t* inside = mask + std::size_t(blockIdx.x % rowsPerImage) * width;
  std::uint16_t* out = labels + std::size_t(blockIdx.x) * width;
  for (int n = threadIdx.x; n < width; n += blockDim.x)
  {
    if (inside[n])
    {
      out[n] = labelAt(row, n, labelShift(scan, ofImage, scan.lateralMm(n), x), voxels, size);
    }
    else
    {
      out[n] = 0;
    }
  }
}

} // namespace

DeviceArray<std::uint16_t> DeviceLabels::slice(const LabelJob& job, int width, int rowsPerImage,
                                               const std::uint8_t* mask, const float* offsetMm, cudaStream_t stream,
                                               Traffic& traffic)
{
  if (sceneId_ != job.sceneId)
  {
    sceneId_ = 0; // stays so when the upload fails
    voxels_.upload(*job.voxels, stream, traffic);
    sceneId_ = job.sceneId;
  }
  rows_.upload(job.rows, stream, traffic);
  if (job.offsetMm)
  {
    offsetMm_.upload(*job.offsetMm, stream, traffic);
    offsetMm = offsetMm_.data();
  }
  DeviceArray<std::uint16_t> labels;
  labels.resize(job.rows.size() * std::size_t(width));
  sliceRows<<<unsigned(job.rows.size()), threads, 0, stream>>>(rows_.data(), width, rowsPerImage, voxels_.data(),
                                                               job.size, mask, job.scan, offsetMm, labels.data());
  check(cudaGetLastError(), "looking up labels");
  return labels;
}

} // namespace sono
