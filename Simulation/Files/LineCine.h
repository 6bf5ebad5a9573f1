#pragma once

#include "Files/FrameOrder.h"
#include "Probe/ScanGeometry.h"

#include <complex>
#include <memory>
#include <string>
#include <vector>

namespace sono {

/// What there is to say of a sequence of demodulated lines (RfLines) besides their numbers.
struct LineCineInfo
{
  ProbeSettings probe;
  ProbePose pose;
  int sampleCount = 0;
  double sampleMm = 0.0; ///< as it is shown: by the probe's assumed speed of sound
  double samplingMHz = 0.0;
  double demodulationMHz = 0.0;
  std::vector<double> timesS; ///< of each frame, in increasing order

  std::size_t lineCount() const { return std::size_t(probe.geometry.totalLineCount()); }
  /// How many there are in a file: IQ, places, and of each line what each element does.
  std::uint64_t floatCount(std::size_t elementCount) const
  {
    return lineCount() * ((2 * timesS.size() + 3) * std::uint64_t(sampleCount) + 2 * elementCount);
  }
};

/// A file of demodulated lines, IQ, after beamforming. `iq` of a frame is lineCount x sampleCount, the samples of a
/// line one after the other; rf = Re(iq exp(i 4 pi f r / c)), f the demodulation frequency.
class LineCine
{
public:
  virtual ~LineCine() = default;
  /// The next frame. Throws Error for another size, one too many, and a full disk.
  void add(const std::vector<std::complex<float>>& iq);
  /// Throws Error where frames are missing, or the disk is full. Before it there is no file of that name.
  void finish();

protected:
  LineCine(const std::string& path, const LineCineInfo& info);

private:
  virtual void write(std::size_t frame, const std::vector<std::complex<float>>& iq) = 0;
  virtual void close() = 0;

  FrameOrder frames_;
};

/// The places of a frame's numbers, in the same order, in m: x lateral, y elevation, z into the body, from the middle
/// of the transducer's face.
std::vector<Vec3d> samplePlacesM(const LineCineInfo& info);

/// One in zea's format (.hdf5; zea's FileSpec of 0.1): beamformed_data with the place of each sample, one transmit a
/// line, the elements of ArrayElements, the probe's pose.
std::unique_ptr<LineCine> zeaFile(const std::string& path, const LineCineInfo& info);
/// One in the Ultrasound File Format of USTB (.uff): uff.beamformed_data with a uff.scan and a uff.probe.
std::unique_ptr<LineCine> uffFile(const std::string& path, const LineCineInfo& info);
/// One of these by the name's ending. Throws Error naming the file for another one, and for what cannot be written.
std::unique_ptr<LineCine> lineFile(const std::string& path, const LineCineInfo& info);

} // namespace sono
