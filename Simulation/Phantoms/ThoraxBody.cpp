#include "Phantoms/ThoraxBody.h"

#include "Core/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace sono {

namespace {

constexpr double apexAsideMm = 15.0;
constexpr double apexToValveMm = 81.0; // of the default heart, along its axis
constexpr double lungAsideMm = 30.0;   // from behind the sternum's middle to 25 mm beside its edge

/// Left ventricle, right ventricle, left atrium, right atrium.
using Chambers = std::array<double, 4>;

/// With what the aorta takes of them.
Chambers chambersMl(const HeartShape& shape, const HeartFrame& frame, const ThoraxAorta& aorta)
{
  constexpr double stepMm = 2.5;
  constexpr int edge = 4; // of blocks of points
  const Heart heart(shape);
  const Vec3d middle = heartSphereCentreMm();
  const double reach = heartSphereRadiusMm(shape);
  const int count = int(std::ceil(2.0 * reach / stepMm));
  const int blocks = (count + edge - 1) / edge;
  const auto place = [&](double i, double j, double k) { return middle - reach + stepMm * Vec3d(i, j, k); };
  std::vector<std::array<int, 4>> layers(blocks, std::array<int, 4>{}); // a layer of blocks each
  const auto addBlock = [&](const Vec3i& first, std::array<int, 4>& layer) {
    constexpr double half = 0.5 * (edge - 1);
    const Vec3d centre = place(first.x + half, first.y + half, first.z + half);
    if (heart.outsideMm(centre, stepMm * half * std::sqrt(3.0)).leastMm > 0.0)
    {
      return;
    }
    const Vec3i end = glm::min(first + edge, Vec3i(count));
    std::array<Vec3d, edge * edge * edge> points;
    std::array<HeartSample, edge * edge * edge> samples;
    int of = 0;
    for (int k = first.z; k < end.z; ++k)
    {
      for (int j = first.y; j < end.y; ++j)
      {
        for (int i = first.x; i < end.x; ++i)
        {
          points[std::size_t(of++)] = place(i, j, k);
        }
      }
    }
    heart.sampleEach(points.data(), of, samples.data());
    for (int n = 0; n < of; ++n)
    {
      const int chamber = samples[std::size_t(n)].label - LeftVentricleBlood;
      if (chamber >= 0 && chamber < 4 && aorta.sample(frame.toWorld(points[std::size_t(n)])) == Background)
      {
        ++layer[std::size_t(chamber)];
      }
    }
  };
  parallelFor(blocks, {}, [&](int k) {
    for (int block = 0; block < blocks * blocks; ++block)
    {
      addBlock(edge * Vec3i(block % blocks, block / blocks, k), layers[std::size_t(k)]);
    }
  });
  Chambers volumes{};
  for (const auto& layer : layers)
  {
    for (int c = 0; c < 4; ++c)
    {
      volumes[c] += layer[c] * stepMm * stepMm * stepMm / 1000.0;
    }
  }
  return volumes;
}

/// Scales each chamber until its volume is within 1 % of what is asked.
HeartShape heartShape(const ThoraxParameters& p, const HeartFrame& frame, const ThoraxAorta& aorta)
{
  const Chambers asked{ p.leftVentricleMl, p.rightVentricleMl, p.leftAtriumMl, p.rightAtriumMl };
  HeartShape shape;
  shape.wallMm = p.wallThicknessMm;
  shape.valveOpening = p.valveOpening;
  Chambers scales{ 1.0, 1.0, 1.0, 1.0 };
  for (int round = 0; round < 30; ++round)
  {
    const Chambers volumes = chambersMl(shape, frame, aorta);
    bool fits = true;
    for (int c = 0; c < 4; ++c)
    {
      const double ratio = asked[c] / std::max(volumes[c], 1.0);
      fits = fits && std::abs(ratio - 1.0) < 0.01;
      scales[c] = std::clamp(scales[c] * std::pow(ratio, 0.35), 0.5, 2.0);
    }
    if (fits)
    {
      return shape;
    }
    shape.leftScale = scales[0];
    shape.rightScale = scales[1];
    shape.leftAtriumScale = scales[2];
    shape.rightAtriumScale = scales[3];
  }
  throw Error(
    "The bundled thorax finds no heart with these chamber volumes and this wall; ask for volumes nearer to the "
    "defaults.");
}

ThoraxAorta aortaOf(const HeartFrame& frame, const AortaPhase& phase)
{
  return { frame.toWorld(aorticValveCentreMm()), frame.axes * aorticFlowDirection(), phase };
}

/// Of a body on its left side: the apex has swung to the left about the aortic valve, by which the heart hangs.
HeartFrame swung(const HeartFrame& frame, double leftLateral)
{
  const double sine = leftLateral * apexAsideMm / apexToValveMm;
  const double cosine = std::sqrt(1.0 - sine * sine);
  const Vec3d lateral = cosine * frame.axes[0] + sine * frame.axes[2];
  const Vec3d axial = cosine * frame.axes[2] - sine * frame.axes[0];
  const Mat3d axes(lateral, frame.axes[1], axial);
  return { frame.originMm + (frame.axes - axes) * aorticValveCentreMm(), axes };
}

/// At a phase, in the places of the end of diastole.
HeartShape shapeAt(HeartShape shape, double phase)
{
  // What is thin between the left atrium and the aorta is made thicker, since the beat squeezes it.
  shape.apartMm = 0.8 * std::min(1.0, 2.0 * contractionAt(phase));
  shape.valveOpening *= inflowOpeningAt(phase);
  return shape;
}

const ThoraxParameters& checked(const ThoraxParameters& parameters)
{
  requireInRange(parameters);
  return parameters;
}

} // namespace

ChestShape chestShape(const ThoraxParameters& p)
{
  ChestShape shape;
  shape.scale = p.bodyScale;
  shape.extraFatMm = p.extraFatMm;
  shape.ribSpacingMm = p.ribSpacingMm;
  shape.lungOverlapMm = p.lungOverlapMm;
  shape.diaphragmDownMm = 35.0 * p.breathing;
  shape.lungAsideMm = lungAsideMm * p.leftLateral;
  return shape;
}

HeartFrame heartFrame(const ThoraxParameters& p)
{
  // The fifth left intercostal space, in front of the mid-axillary line. The heart's long axis goes from there to the
  // right, back and up.
  const Vec3d axial = glm::normalize(Vec3d(-0.53, 0.65, 0.545));
  const Vec3d leftward(0.84, 0.33, 0.42);
  const Vec3d lateral = glm::normalize(leftward - glm::dot(leftward, axial) * axial);
  ChestShape lean = chestShape(p);
  lean.extraFatMm = 0.0;
  const Vec3d shift(p.heartLeftMm, p.heartBackMm, p.heartUpMm - 10.0 * p.breathing);
  const Vec3d originMm = skinPointMm(lean, 88.0, -86.7, -45.0) + shift;
  return swung({ originMm, Mat3d(lateral, glm::cross(axial, lateral), axial) }, p.leftLateral);
}

ThoraxBody::ThoraxBody(const ThoraxParameters& parameters)
  : chest_(chestShape(checked(parameters)))
  , frame_(heartFrame(parameters))
  , beat_(heartShape(parameters, frame_, aortaOf(frame_, {})), parameters.ejectionPercent, parameters.phase)
  , heart_(shapeAt(beat_.heart().shape(), parameters.phase))
  , aorta_(aortaOf(frame_, { outflowOpeningAt(parameters.phase), heart_.shape().apartMm }))
{
}

Vec3d ThoraxBody::restingPlaceMm(const Vec3d& world) const
{
  const Vec3d now = frame_.fromWorld(world);
  const Vec3d resting = beat_.restingPlaceMm(now);
  return resting == now ? world : frame_.toWorld(resting); // what stands still does so to the last digit
}

Vec3d ThoraxBody::placeMm(const Vec3d& resting) const
{
  return frame_.toWorld(beat_.placeMm(frame_.fromWorld(resting)));
}

ThoraxLabel ThoraxBody::sample(const Vec3d& p) const
{
  const Vec3d now = frame_.fromWorld(p);
  const Vec3d q = beat_.restingPlaceMm(now);
  HeartSample heart;
  if (heart_.isNear(q))
  {
    heart = heart_.sample(q);
  }
  if (const ThoraxLabel vessel = aorta_.sample(q == now ? p : frame_.toWorld(q)))
  {
    heart.label = vessel;
  }
  const ChestHeight height = chestHeight(p.z, chest_);
  const WallPoint wall = wallPoint(p.x, p.y, height.halfWidthMm, height.halfDepthMm);
  return chestAt(p, wall, height, diaphragmMm(p.x, p.y), now, chest_).with(heart);
}

} // namespace sono
