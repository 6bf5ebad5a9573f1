#include "Channels/ChannelPoints.h"

namespace sono {

void ChannelPoints::push(const Vec3f& place, float amplitudeRe, float amplitudeIm, float lag, float sink, float rising)
{
  x.push_back(place.x);
  y.push_back(place.y);
  z.push_back(place.z);
  re.push_back(amplitudeRe);
  im.push_back(amplitudeIm);
  lagMm.push_back(lag);
  sinkNp.push_back(sink);
  rise.push_back(rising);
}

void ChannelPoints::append(const ChannelPoints& other)
{
  const auto add = [](std::vector<float>& to, const std::vector<float>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  add(x, other.x);
  add(y, other.y);
  add(z, other.z);
  add(re, other.re);
  add(im, other.im);
  add(lagMm, other.lagMm);
  add(sinkNp, other.sinkNp);
  add(rise, other.rise);
}

ChannelPoints ChannelPoints::ordered(const std::vector<std::size_t>& numbers) const
{
  ChannelPoints out;
  const auto take = [&](const std::vector<float>& from, std::vector<float>& to) {
    to.reserve(numbers.size());
    for (const std::size_t n : numbers)
    {
      to.push_back(from[n]);
    }
  };
  take(x, out.x);
  take(y, out.y);
  take(z, out.z);
  take(re, out.re);
  take(im, out.im);
  take(lagMm, out.lagMm);
  take(sinkNp, out.sinkNp);
  take(rise, out.rise);
  return out;
}

ProbeFrame::ProbeFrame(const ProbePose& given)
{
  const ProbePose pose = given.orthonormalized();
  originMm_ = pose.positionMm;
  axes_[0] = pose.lateral;
  axes_[1] = glm::cross(pose.axial, pose.lateral);
  axes_[2] = pose.axial;
}

Vec3d ProbeFrame::fromWorld(const Vec3d& world) const
{
  return glm::transpose(axes_) * (world - originMm_);
}

Vec3d ProbeFrame::toWorld(const Vec3d& place) const
{
  return originMm_ + axes_ * place;
}

ChannelPoints channelPoints(const PointScatterers& points, const ProbePose& pose, double scale)
{
  const ProbeFrame frame(pose);
  ChannelPoints out;
  for (const PointScatterer& point : points.all())
  {
    out.push(Vec3f(frame.fromWorld(point.positionMm)), float(scale * point.amplitude), 0.0f, 0.0f, 0.0f);
  }
  return out;
}

} // namespace sono
