#include "Phantoms/TestObjects.h"

#include "Core/Require.h"
#include "Phantoms/PhantomVolume.h"

#include <string>

namespace sono {

namespace {

LabelVolume makeSphere(const std::string& tissue, const TestObjectSettings& settings)
{
  const double radius = 0.5 * settings.diameterMm;
  return makePhantomVolume({ 100.0, 80.0, 120.0 }, settings.spacingMm, { "phantom_gel", tissue }, [&](const Vec3d& p) {
    const Vec3d q = p - Vec3d(0.0, 0.0, settings.depthMm);
    return glm::dot(q, q) < radius * radius ? 1 : 0;
  });
}

/// Layers of an intercostal approach, thicknesses as in a lean adult (chosen). The rib lies beside the probe's axis, so
/// that one half of the image stays free.
LabelVolume makeRib(const TestObjectSettings& settings)
{
  enum Layer
  {
    Skin,
    Fat,
    Muscle,
    Liver,
    Bone
  };
  return makePhantomVolume({ 120.0, 60.0, 120.0 }, settings.spacingMm,
                           { "skin", "fat", "muscle", "liver", "cortical_bone" }, [](const Vec3d& p) {
                             const double across = (p.x + 7.0) / 6.5;
                             const double along = (p.z - 14.0) / 4.0;
                             if (across * across + along * along < 1.0)
                             {
                               return int(Bone);
                             }
                             return int(p.z < 2.0 ? Skin : p.z < 8.0 ? Fat : p.z < 22.0 ? Muscle : Liver);
                           });
}

} // namespace

void TestObjectSettings::validate() const
{
  requireInRange(spacingMm >= 0.1 && spacingMm <= 5.0, "voxel size of the phantom (mm)", spacingMm, "0.1 to 5");
  requireInRange(diameterMm >= 1.0 && diameterMm <= 60.0, "diameter of the sphere (mm)", diameterMm, "1 to 60");
  requireInRange(depthMm > 0.5 * diameterMm && depthMm <= 110.0, "depth of the sphere (mm)", depthMm,
                 "more than its radius and at most 110");
}

LabelVolume makeTestObject(TestObject object, const TestObjectSettings& settings)
{
  settings.validate();
  switch (object)
  {
    case TestObject::EnhancementSphere:
      return makeSphere("water", settings);
    case TestObject::ShadowSphere:
      return makeSphere("cortical_bone", settings);
    case TestObject::Rib:
      return makeRib(settings);
    case TestObject::SpeckleCube:
      return makePhantomVolume(Vec3d(40.0), settings.spacingMm, { "phantom_speckle" }, [](const Vec3d&) { return 0; });
  }
  throw Error("there is no such test object: choose a sphere, the rib or the speckle cube");
}

} // namespace sono
