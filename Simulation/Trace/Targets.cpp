#include "Trace/Targets.h"

#include "Core/Progress.h"

#include <embree3/rtcore.h> // the one place that includes Embree

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace sono {

namespace {

/// What a query asks, where Embree's filter can find it.
struct QueryContext
{
  RTCIntersectContext embree;
  bool inside;
};

/// Outside a target only surfaces that the ray enters count, inside only those that it leaves.
void keepFacing(const RTCFilterFunctionNArguments* args)
{
  const auto* context = reinterpret_cast<const QueryContext*>(args->context);
  const auto* ray = reinterpret_cast<const RTCRay*>(args->ray);
  const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
  const float along = hit->Ng_x * ray->dir_x + hit->Ng_y * ray->dir_y + hit->Ng_z * ray->dir_z;
  if (context->inside ? along <= 0.0f : along >= 0.0f)
  {
    args->valid[0] = 0;
  }
}

void check(const TargetSurface& target)
{
  const std::string name = "target '" + target.name + "'";
  if (target.triangles.empty())
  {
    throw Error(name + " has no triangles: give it a closed surface");
  }
  for (const Vec3d& p : target.pointsMm)
  {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
    {
      throw Error(name + " has a point that is not a number: repair its geometry");
    }
  }
  // Closed and consistently oriented: every edge is run through once in each direction.
  std::map<std::pair<int, int>, int> edges;
  for (const auto& t : target.triangles)
  {
    for (int i = 0; i < 3; ++i)
    {
      const int a = t[std::size_t(i)];
      const int b = t[std::size_t((i + 1) % 3)];
      if (a < 0 || b < 0 || a >= int(target.pointsMm.size()) || b >= int(target.pointsMm.size()))
      {
        throw Error(name + " has a triangle with a point that does not exist: repair its geometry");
      }
      ++edges[{ a, b }];
    }
  }
  for (const auto& [edge, count] : edges)
  {
    const auto back = edges.find({ edge.second, edge.first });
    if (count != 1 || back == edges.end() || back->second != 1)
    {
      throw Error(name + " is not a closed surface: close its holes and merge double points (Fill Holes, Clean)");
    }
  }
}

/// Six times the enclosed volume, positive when the triangles run counter-clockwise seen from outside.
double signedVolume(const TargetSurface& target)
{
  double sum = 0.0;
  const Vec3d anchor = target.pointsMm[0];
  for (const auto& t : target.triangles)
  {
    const Vec3d a = target.pointsMm[std::size_t(t[0])] - anchor;
    const Vec3d b = target.pointsMm[std::size_t(t[1])] - anchor;
    const Vec3d c = target.pointsMm[std::size_t(t[2])] - anchor;
    sum += glm::dot(a, glm::cross(b, c));
  }
  return sum;
}

} // namespace

struct TargetScene::Embree
{
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  ~Embree()
  {
    if (scene)
    {
      rtcReleaseScene(scene);
    }
    if (device)
    {
      rtcReleaseDevice(device);
    }
  }
};

std::vector<BvhTriangle> localTriangles(const std::vector<TargetSurface>& targets, const Mat3d& toLocal,
                                        const Vec3d& cornerWorldMm)
{
  std::vector<BvhTriangle> triangles;
  // A left-handed grid mirrors the triangles.
  const double hand = glm::determinant(toLocal);
  for (std::size_t i = 0; i < targets.size(); ++i)
  {
    const TargetSurface& target = targets[i];
    check(target);
    const bool flip = signedVolume(target) * hand < 0.0;
    const auto local = [&](int point) {
      return Vec3f(toLocal * (target.pointsMm[std::size_t(point)] - cornerWorldMm));
    };
    for (const auto& t : target.triangles)
    {
      triangles.push_back({ local(t[0]), local(flip ? t[2] : t[1]), local(flip ? t[1] : t[2]), std::int32_t(i) });
    }
  }
  return triangles;
}

TargetScene::TargetScene(std::vector<BvhTriangle> triangles)
  : triangles_(std::move(triangles))
{
  if (empty())
  {
    return;
  }
  embree_ = std::make_unique<Embree>();
  embree_->device = rtcNewDevice(nullptr);
  if (!embree_->device)
  {
    throw Error("Embree could not start for the targets: remove the targets or check the Embree installation");
  }
  embree_->scene = rtcNewScene(embree_->device);
  // Watertight edges: a ray must not slip between two triangles of a thin wire.
  rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                             3 * sizeof(float), 3 * triangles_.size()));
  auto* corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(unsigned), triangles_.size()));
  unsigned corner = 0;
  for (const BvhTriangle& t : triangles_)
  {
    for (const Vec3f& p : { t.a, t.b, t.c })
    {
      *points++ = p.x;
      *points++ = p.y;
      *points++ = p.z;
      *corners++ = corner++;
    }
  }
  rtcSetGeometryIntersectFilterFunction(geometry, keepFacing);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(embree_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(embree_->scene);
}

TargetScene::~TargetScene() = default;

TargetHit TargetScene::nearest(const Vec3f& position, const Vec3f& direction, float tMax, bool inside) const
{
  QueryContext context;
  rtcInitIntersectContext(&context.embree);
  context.inside = inside;
  RTCRayHit query{};
  query.ray.org_x = position.x;
  query.ray.org_y = position.y;
  query.ray.org_z = position.z;
  query.ray.dir_x = direction.x;
  query.ray.dir_y = direction.y;
  query.ray.dir_z = direction.z;
  query.ray.tfar = tMax;
  query.ray.mask = ~0u;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(embree_->scene, &context.embree, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
  {
    return { tMax, Vec3f(0.0f), -1 };
  }
  return { query.ray.tfar, glm::normalize(Vec3f(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z)),
           triangles_[query.hit.primID].target };
}

} // namespace sono
