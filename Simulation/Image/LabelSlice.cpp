#include "Image/LabelSlice.h"

#include "Core/ParallelFor.h"
#include "Core/Simd.h"
#include "Image/RowBeams.h"

#include <tbb/enumerable_thread_specific.h>

#include <cmath>

namespace sono {

namespace {

/// The voxel index of a place in the probe's frame, (lateral, elevational, axial) mm.
class IndexInLabels
{
public:
  IndexInLabels(const LabelVolume& labels, const ProbePose& pose)
    : labels_(labels)
    , pose_(pose)
    , elevation_(glm::cross(pose.axial, pose.lateral))
  {
  }
  Vec3d at(const Vec3d& p) const
  {
    return labels_.placement.indexFromWorld(pose_.positionMm + p.x * pose_.lateral + p.y * elevation_ +
                                            p.z * pose_.axial);
  }

private:
  const LabelVolume& labels_;
  const ProbePose& pose_;
  Vec3d elevation_;
};

/// What labelShift asks of a row of pixels.
struct RowShifts
{
  explicit RowShifts(int count)
    : line(std::size_t(count))
    , depthMm(std::size_t(count))
    , lateralMm(std::size_t(count))
    , axialMm(std::size_t(count))
  {
  }

  std::vector<float> line, depthMm;
  std::vector<float> lateralMm, axialMm; ///< how far away lies what is shown
};

/// labelShift of each pixel of a row, of lines that are not steered.
SONO_SIMD_CLONES __attribute__((flatten)) void shiftRow(const PlaneScan& of, const float* offsetMm,
                                                        const float* __restrict lateralMm, float x, int count,
                                                        float* __restrict line, float* __restrict depthMm,
                                                        float* __restrict lateral, float* __restrict axial)
{
  const PlaneBeams beams = of.beams;
  const ScannedArea area = of.area;
  const BeamSamples samples = of.samples(offsetMm);
  const float samplesPerMm = of.samplesPerMm;
  const float morePerMm = of.rangePerMm - 1.0f;
  beamsOfRow(beams, lateralMm, x, count, line, depthMm);
  for (int i = 0; i < count; ++i)
  {
    axial[i] = offsetMm ? samples.at(line[i], depthMm[i] * samplesPerMm) : 0.0f;
  }
  for (int i = 0; i < count; ++i)
  {
    const float mm = (area.contains(line[i], depthMm[i]) ? axial[i] : 0.0f) + depthMm[i] * morePerMm;
    const float length = sqrtf(lateralMm[i] * lateralMm[i] + x * x);
    const bool isStraight = beams.parallel | (length == 0.0f);
    lateral[i] = isStraight ? 0.0f : mm * (lateralMm[i] / length);
    axial[i] = isStraight ? mm : mm * (x / length);
  }
}

} // namespace

std::vector<LabelRow> labelRows(const LabelVolume& labels, const ProbePose& pose, const PlaneImage& layout)
{
  const IndexInLabels index(labels, pose);
  std::vector<LabelRow> rows(std::size_t(layout.height));
  for (int row = 0; row < layout.height; ++row)
  {
    const Vec3d first(layout.lateralMinMm, 0.0, layout.axialMinMm + layout.pixelMm * row);
    const Vec3d start = index.at(first);
    rows[std::size_t(row)] = { start, index.at(first + Vec3d(layout.pixelMm, 0.0, 0.0)) - start,
                               index.at(first + Vec3d(0.0, 0.0, 1.0)) - start };
  }
  return rows;
}

PlaneScan offsetScan(const ScanGeometry& geometry, int binCount, double binMm, double pixelMm)
{
  return binCount > 0 ? planeScan(geometry, binCount, binMm, pixelMm)
                      : planeScan(geometry, 1, geometry.depthMm, pixelMm);
}

std::vector<std::uint16_t> sliceLabels(const LabelVolume& labels, const ScanGeometry& geometry, const ProbePose& pose,
                                       const PlaneImage& image, const DepthOffsets& offsets)
{
  const std::vector<LabelRow> rows = labelRows(labels, pose, image);
  const PlaneScan scan = offsetScan(geometry, offsets.binCount, offsets.binMm, image.pixelMm);
  const float* offsetMm = offsets.any() ? offsets.mm->data() : nullptr;
  std::vector<float> lateralMm;
  for (int i = 0; i < image.width; ++i)
  {
    lateralMm.push_back(scan.lateralMm(i));
  }
  std::vector<std::uint16_t> out(image.mask.size(), 0);
  tbb::enumerable_thread_specific<RowShifts> rooms([&] { return RowShifts(image.width); });
  parallelFor(image.height, {}, [&](int j) {
    RowShifts& shifts = rooms.local();
    const float x = scan.beams.axialFromCentre(scan.axialMm(j));
    if (scan.fanCount == 1)
    {
      shiftRow(scan, offsetMm, lateralMm.data(), x, image.width, shifts.line.data(), shifts.depthMm.data(),
               shifts.lateralMm.data(), shifts.axialMm.data());
    }
    const std::size_t at = std::size_t(j) * std::size_t(image.width);
    for (int i = 0; i < image.width; ++i)
    {
      if (image.mask[at + std::size_t(i)])
      {
        const std::size_t n = std::size_t(i);
        const LabelShift shift = scan.fanCount == 1
                                   ? LabelShift{ double(shifts.lateralMm[n]) / scan.pixelMm, double(shifts.axialMm[n]) }
                                   : labelShift(scan, offsetMm, lateralMm[n], x);
        out[at + n] = labelAt(rows[std::size_t(j)], i, shift, labels.voxels.data(), labels.placement.size);
      }
    }
  });
  return out;
}

std::vector<std::uint16_t> sliceLabels(const LabelVolume& labels, const ScanGeometry& geometry, const ProbePose& pose,
                                       const VolumeImage& image, const DepthOffsets& offsets)
{
  const IndexInLabels index(labels, pose);
  const VolumeImage shift = offsets.any()
                              ? scanConvertVolume(geometry, *offsets.mm, offsets.binCount, offsets.binMm, image.voxelMm)
                              : VolumeImage{};
  const double rangePerMm = 1.0 / geometry.shownPerRange();
  std::vector<std::uint16_t> out(image.mask.size(), 0);
  parallelFor(image.size.y * image.size.z, {}, [&](int row) {
    const std::size_t at = std::size_t(row) * std::size_t(image.size.x);
    for (int i = 0; i < image.size.x; ++i)
    {
      if (image.mask[at + std::size_t(i)])
      {
        Vec3d place = image.minMm + image.voxelMm * Vec3d(i, row % image.size.y, row / image.size.y);
        const double fromApex = glm::length(place);
        if (fromApex > 0.0)
        {
          place *= rangePerMm + (offsets.any() ? double(shift.value[at + std::size_t(i)]) / fromApex : 0.0);
        }
        out[at + std::size_t(i)] = labelAtIndex(index.at(place), labels.voxels.data(), labels.placement.size);
      }
    }
  });
  return out;
}

} // namespace sono
