#include "Phantoms/TestObjects.h"

#include "Core/Require.h"
#include "Phantoms/PhantomVolume.h"

#include <cmath>
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

/// A transverse section above the jugular notch, the same along the neck but for the nodule; places and sizes as in an
/// adult's (chosen). x to the left of the picture is the patient's right.
LabelVolume makeNeck(const TestObjectSettings& settings)
{
  enum Structure
  {
    Skin,
    Fat,
    Muscle,
    Thyroid,
    Nodule,
    Cartilage,
    Air,
    Lumen,
    Wall,
    Oesophagus,
    Vertebra
  };
  const auto within = [](double x, double y, double halfX, double halfY) {
    return x * x / (halfX * halfX) + y * y / (halfY * halfY) < 1.0;
  };
  return makePhantomVolume({ 100.0, 50.0, 60.0 }, settings.spacingMm,
                           { "skin", "fat", "muscle", "thyroid_gland", "nodule", "tracheal_cartilage", "air",
                             "carotid_jugular_blood", "vessel_wall", "oesophagus", "vertebra" },
                           [&](const Vec3d& p) {
                             const double side = std::abs(p.x);
                             if (p.z < 1.5)
                             {
                               return int(Skin);
                             }
                             if (within(p.x, p.z - 28.0, 8.5, 8.5))
                             {
                               return int(Air);
                             }
                             if (within(p.x, p.z - 28.0, 10.0, 10.0))
                             {
                               return int(Cartilage);
                             }
                             if (within(side - 29.0, p.z - 25.0, 3.3, 3.3) || within(side - 36.0, p.z - 20.0, 6.0, 3.5))
                             {
                               return int(Lumen);
                             }
                             if (within(side - 29.0, p.z - 25.0, 4.1, 4.1) || within(side - 36.0, p.z - 20.0, 6.5, 4.0))
                             {
                               return int(Wall);
                             }
                             if (glm::length((p - Vec3d(19.0, 0.0, 21.0)) / Vec3d(4.5, 4.5, 4.0)) < 1.0)
                             {
                               return int(Nodule);
                             }
                             if (within(side - 17.0, p.z - 23.0, 8.5, 9.5) || (side < 14.0 && p.z > 14.5 && p.z < 18.0))
                             {
                               return int(Thyroid);
                             }
                             if (within(p.x - 10.0, p.z - 41.0, 6.0, 4.0))
                             {
                               return int(Oesophagus);
                             }
                             if (within(p.x, p.z - 60.0, 22.0, 13.0))
                             {
                               return int(Vertebra);
                             }
                             const bool isStrap = p.z > 6.0 && p.z < 12.5 && side < 24.0 && side > 1.0;
                             const bool isSternocleidomastoid = within(side - 33.0, p.z - 10.0, 13.0, 4.5);
                             const bool isDeep = within(side - 24.0, p.z - 44.0, 14.0, 9.0);
                             return int(isStrap || isSternocleidomastoid || isDeep ? Muscle : Fat);
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
    case TestObject::Neck:
      return makeNeck(settings);
  }
  throw Error("there is no such test object: choose a sphere, the rib, the speckle cube or the neck");
}

} // namespace sono
