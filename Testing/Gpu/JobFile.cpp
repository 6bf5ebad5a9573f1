#include "JobFile.h"

#include "Core/Progress.h"

#include <fstream>
#include <type_traits>

namespace sono {

namespace {

constexpr std::uint64_t magic = 0x31626f6a6f6e6f73u; // "sonojob1"

/// Passes the parts of a job to a file, or from it; both ways read alike.
class Archive
{
public:
  Archive(const std::string& path, bool writing)
    : path_(path)
    , writing_(writing)
    , stream_(path, std::ios::binary | (writing ? std::ios::out | std::ios::trunc : std::ios::in))
  {
    if (!stream_)
    {
      throw Error(path + " cannot be opened: check its folder and permissions");
    }
  }

  template<class T>
  void value(T& v)
  {
    static_assert(std::is_trivially_copyable_v<T>, "stored as it lies in memory");
    bytes(reinterpret_cast<char*>(&v), sizeof v);
  }
  template<class T>
  void vector(std::vector<T>& v)
  {
    std::uint64_t count = v.size();
    value(count);
    v.resize(count);
    bytes(reinterpret_cast<char*>(v.data()), count * sizeof(T));
  }
  template<class T>
  void shared(SharedVector<T>& v)
  {
    std::vector<T> copy = writing_ ? *v : std::vector<T>();
    vector(copy);
    if (!writing_)
    {
      v = std::make_shared<const std::vector<T>>(std::move(copy));
    }
  }
  template<class T, class Parts>
  void optional(std::optional<T>& v, const Parts& parts)
  {
    bool some = v.has_value();
    value(some);
    if (some)
    {
      if (!v)
      {
        v.emplace();
      }
      parts(*v);
    }
  }
  bool writing() const { return writing_; }

private:
  void bytes(char* at, std::size_t count)
  {
    if (writing_)
    {
      stream_.write(at, std::streamsize(count));
    }
    else
    {
      stream_.read(at, std::streamsize(count));
    }
    if (!stream_)
    {
      throw Error(path_ + " is not a complete job of this build: write it again with WriteGpuJobs");
    }
  }

  std::string path_;
  bool writing_;
  std::fstream stream_;
};

void pass(Archive& a, SightJob& sight)
{
  a.value(sight.view);
  a.vector(sight.seen);
  a.value(sight.lateralMm);
  a.value(sight.elevationalMm);
}

void pass(Archive& a, TraceJob& trace)
{
  a.value(trace.view);
  a.vector(trace.media);
  a.vector(trace.lines);
  TraceRegion region = a.writing() ? *trace.region : TraceRegion();
  a.value(region.box);
  a.value(region.spacing);
  a.vector(region.cell);
  a.vector(region.firstRecord);
  a.vector(region.record);
  trace.region = std::make_shared<const TraceRegion>(std::move(region));
  a.vector(trace.targets.nodes);
  a.vector(trace.targets.triangles);
  a.value(trace.paths);
  a.value(trace.binCount);
  a.value(trace.binMm);
  a.value(trace.echoCount);
  a.value(trace.echoSampleMm);
  a.value(trace.radPerMm);
}

void pass(Archive& a, TissueJob& tissues)
{
  a.vector(tissues.beams);
  a.shared(tissues.voxels);
  a.value(tissues.sceneId);
  a.value(tissues.size);
  a.value(tissues.spacing);
  a.value(tissues.media);
  a.value(tissues.cellMm);
  a.value(tissues.seed);
  a.optional(tissues.sight, [&](SightJob& sight) { pass(a, sight); });
}

void pass(Archive& a, PointJob& points)
{
  a.vector(points.beams);
  PointTable table = a.writing() ? *points.table : PointTable();
  a.vector(table.x);
  a.vector(table.y);
  a.vector(table.z);
  a.vector(table.amplitude);
  a.vector(table.begin);
  a.value(table.firstBrick);
  a.value(table.bricks);
  a.value(table.edgeMm);
  points.table = std::make_shared<const PointTable>(std::move(table));
  a.optional(points.sight, [&](SightJob& sight) { pass(a, sight); });
}

void pass(Archive& a, EchoJob& echo)
{
  a.value(echo.lineCount);
  a.value(echo.sampleCount);
  a.value(echo.sumCount);
  a.value(echo.sampleMm);
  a.value(echo.radPerMm);
  a.vector(echo.pulseRe);
  a.vector(echo.pulseIm);
  a.vector(echo.boundaryLevel);
  a.optional(echo.field, [&](FieldJob& field) {
    a.value(field.view);
    a.shared(field.values);
  });
  a.optional(echo.tissues, [&](TissueJob& tissues) { pass(a, tissues); });
  a.optional(echo.points, [&](PointJob& points) { pass(a, points); });
}

void pass(Archive& a, BModeJob& bmode)
{
  a.vector(bmode.gainFactor);
  a.vector(bmode.gainDb);
  a.value(bmode.automaticReference);
  a.value(bmode.referenceAmplitude);
  a.value(bmode.rangeDb);
  a.value(bmode.rejectDb);
  a.value(bmode.greyMap);
  a.value(bmode.noiseRms);
  a.value(bmode.noiseSeed);
}

void pass(Archive& a, JobFile& file)
{
  std::uint64_t found = magic;
  a.value(found);
  if (found != magic)
  {
    throw Error("that is no job: write one with WriteGpuJobs");
  }
  a.value(file.job.images);
  a.optional(file.job.trace, [&](TraceJob& trace) { pass(a, trace); });
  a.optional(file.job.echo, [&](EchoJob& echo) { pass(a, echo); });
  a.optional(file.job.bmode, [&](BModeJob& bmode) { pass(a, bmode); });
  a.optional(file.job.scan, [&](PlaneScan& scan) { a.value(scan); });
  a.vector(file.cpuIq);
  a.value(file.scatterers);
}

} // namespace

void writeJob(const JobFile& file, const std::string& path)
{
  Archive archive(path, true);
  JobFile copy = file;
  pass(archive, copy);
}

JobFile readJob(const std::string& path)
{
  Archive archive(path, false);
  JobFile file;
  pass(archive, file);
  return file;
}

} // namespace sono
