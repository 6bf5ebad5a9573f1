#include "Files/LineCine.h"

#include "Files/EchoFormat.h"

namespace sono {

LineCine::LineCine(const std::string& path, const LineCineInfo& info)
  : frames_(path, info.lineCount() * std::size_t(info.sampleCount), info.timesS, "lines",
            "keep the probe's depth and its lines the same in all")
{
}

void LineCine::add(const std::vector<std::complex<float>>& iq)
{
  write(frames_.next(iq.size()), iq);
}

void LineCine::finish()
{
  frames_.finish();
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
  switch (echoFormatOf(path))
  {
    case EchoFormat::Zea:
      return zeaFile(path, info);
    default:
      return uffFile(path, info);
  }
}

} // namespace sono
