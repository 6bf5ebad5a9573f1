#include "Files/LineCine.h"

#include "Core/EndsWith.h"
#include "Core/Error.h"

namespace sono {

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why)
{
  throw Error("cannot write '" + path + "': " + why + ".");
}

} // namespace

LineCine::LineCine(const std::string& path, const LineCineInfo& info)
  : path_(path)
  , valueCount_(info.lineCount() * std::size_t(info.sampleCount))
  , frameCount_(info.timesS.size())
{
  if (frameCount_ == 0 || valueCount_ == 0)
  {
    refuse(path, "there are no lines; simulate some first");
  }
  for (std::size_t n = 1; n < frameCount_; ++n)
  {
    if (!(info.timesS[n] > info.timesS[n - 1]))
    {
      refuse(path, "frame " + std::to_string(n + 1) + " is not later than the one before; set times that increase");
    }
  }
}

void LineCine::add(const std::vector<std::complex<float>>& iq)
{
  const std::string number = "frame " + std::to_string(added_ + 1);
  if (iq.size() != valueCount_)
  {
    refuse(path_, number + " has " + std::to_string(iq.size()) + " samples and the first " +
                    std::to_string(valueCount_) + "; keep the probe's depth and its lines the same in all");
  }
  if (added_ == frameCount_)
  {
    refuse(path_, number + " is one more than the " + std::to_string(frameCount_) + " that were announced");
  }
  write(added_, iq);
  ++added_;
}

void LineCine::finish()
{
  if (added_ < frameCount_)
  {
    refuse(path_, "it has " + std::to_string(added_) + " frames of " + std::to_string(frameCount_));
  }
  close();
}

std::vector<Vec3d> samplePlacesM(const LineCineInfo& info)
{
  constexpr double mPerMm = 1e-3;
  std::vector<Vec3d> places;
  places.reserve(info.lineCount() * std::size_t(info.sampleCount));
  for (const ScanLine& line : makeScanLines(info.probe.geometry, ProbePose()))
  {
    for (int sample = 0; sample < info.sampleCount; ++sample)
    {
      places.push_back(mPerMm * (line.originMm + double(sample) * info.sampleMm * line.axis));
    }
  }
  return places;
}

std::unique_ptr<LineCine> lineFile(const std::string& path, const LineCineInfo& info)
{
  if (endsWith(path, ".hdf5") || endsWith(path, ".h5"))
  {
    return zeaFile(path, info);
  }
  if (endsWith(path, ".uff"))
  {
    return uffFile(path, info);
  }
  refuse(path, "lines go into files that end in .hdf5 (zea) or .uff (USTB); give it such a name");
}

} // namespace sono
