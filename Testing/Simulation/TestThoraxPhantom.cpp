#include "Phantoms/ThoraxPhantom.h"

#include "Core/Progress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace {

using namespace sono;

const LabelVolume& thorax(int spacingMm)
{
  static const LabelVolume fine = makeThoraxPhantom(1.0);
  static const LabelVolume coarse = makeThoraxPhantom(2.0);
  return spacingMm == 1 ? fine : coarse;
}

std::map<int, std::string> namesOf(const LabelVolume& volume)
{
  std::map<int, std::string> names;
  for (const LabelInfo& label : volume.labels)
  {
    names[label.id] = label.name;
  }
  return names;
}

std::map<std::string, double> volumesMl(const LabelVolume& volume)
{
  const Vec3d s = volume.placement.spacingMm;
  std::map<int, std::string> names = namesOf(volume);
  std::map<int, std::size_t> counts;
  for (const std::uint16_t id : volume.voxels)
  {
    ++counts[id];
  }
  std::map<std::string, double> volumes;
  for (const auto& [id, count] : counts)
  {
    volumes[names[id]] = double(count) * s.x * s.y * s.z / 1000.0;
  }
  return volumes;
}

std::string nameAt(const LabelVolume& volume, const Vec3d& world)
{
  static const std::map<int, std::string> names = namesOf(thorax(1));
  const Vec3i size = volume.placement.size;
  const Vec3i i(glm::round(volume.placement.indexFromWorld(world)));
  if (i.x < 0 || i.y < 0 || i.z < 0 || i.x >= size.x || i.y >= size.y || i.z >= size.z)
  {
    return "background";
  }
  return names.at(volume.voxels[(std::size_t(i.z) * size.y + i.y) * size.x + i.x]);
}

/// Every pair of names whose voxels share a face, both ways round.
std::set<std::pair<std::string, std::string>> neighbours(const LabelVolume& volume)
{
  const Vec3i size = volume.placement.size;
  const std::size_t step[3] = { 1, std::size_t(size.x), std::size_t(size.x) * size.y };
  std::set<std::pair<int, int>> pairs;
  for (int k = 0; k < size.z; ++k)
  {
    for (int j = 0; j < size.y; ++j)
    {
      for (int i = 0; i < size.x; ++i)
      {
        const std::size_t here = i + j * step[1] + k * step[2];
        const bool more[3] = { i + 1 < size.x, j + 1 < size.y, k + 1 < size.z };
        for (int axis = 0; axis < 3; ++axis)
        {
          if (more[axis] && volume.voxels[here] != volume.voxels[here + step[axis]])
          {
            pairs.emplace(volume.voxels[here], volume.voxels[here + step[axis]]);
          }
        }
      }
    }
  }
  std::map<int, std::string> names = namesOf(volume);
  std::set<std::pair<std::string, std::string>> named;
  for (const auto& [a, b] : pairs)
  {
    named.emplace(names[a], names[b]);
    named.emplace(names[b], names[a]);
  }
  return named;
}

bool startsWith(const std::string& text, const std::string& prefix)
{
  return text.rfind(prefix, 0) == 0;
}

bool isBone(const std::string& name)
{
  return startsWith(name, "rib_") || name == "sternum" || name == "costal_cartilages";
}

/// Size of the largest 6-connected region of a label over all of its voxels.
double largestPart(const LabelVolume& volume, int id)
{
  const Vec3i size = volume.placement.size;
  const std::ptrdiff_t row = size.x;
  const std::ptrdiff_t slice = row * size.y;
  std::vector<bool> seen(volume.voxels.size(), false);
  std::size_t all = 0;
  std::size_t largest = 0;
  for (std::size_t start = 0; start < volume.voxels.size(); ++start)
  {
    if (volume.voxels[start] != id || seen[start])
    {
      continue;
    }
    std::vector<std::size_t> open{ start };
    seen[start] = true;
    std::size_t part = 0;
    while (!open.empty())
    {
      const std::size_t here = open.back();
      open.pop_back();
      ++part;
      for (const std::ptrdiff_t step : { std::ptrdiff_t(1), std::ptrdiff_t(-1), row, -row, slice, -slice })
      {
        const std::size_t next = here + step; // chambers lie far from the volume's faces
        if (volume.voxels[next] == id && !seen[next])
        {
          seen[next] = true;
          open.push_back(next);
        }
      }
    }
    all += part;
    largest = std::max(largest, part);
  }
  return double(largest) / double(all);
}

/// Share of each label in the A4C fan of half-angle `halfDeg` down to `depthMm`, by area.
std::map<std::string, double> fanShares(double halfDeg, double depthMm)
{
  const ProbePose pose = thoraxPhantomA4C();
  std::map<std::string, double> shares;
  double total = 0.0;
  for (double deg = -halfDeg; deg <= halfDeg; deg += 0.25)
  {
    const double angle = deg * std::acos(-1.0) / 180.0;
    const Vec3d ray = std::cos(angle) * pose.axial + std::sin(angle) * pose.lateral;
    for (double r = 0.125; r < depthMm; r += 0.25)
    {
      shares[nameAt(thorax(1), pose.positionMm + r * ray)] += r;
      total += r;
    }
  }
  for (auto& [name, share] : shares)
  {
    share /= total;
  }
  return shares;
}

TEST(ThoraxPhantom, HasEveryLabelOnceWithNameAndColour)
{
  std::set<std::string> expected{ "background",
                                  "skin",
                                  "subcutaneous_fat",
                                  "muscle",
                                  "sternum",
                                  "costal_cartilages",
                                  "vertebrae",
                                  "spinal_cord",
                                  "lung_left",
                                  "lung_right",
                                  "mediastinal_fat",
                                  "pericardium",
                                  "left_ventricle_myocardium",
                                  "interventricular_septum",
                                  "right_ventricle_myocardium",
                                  "left_atrium_wall",
                                  "right_atrium_wall",
                                  "interatrial_septum",
                                  "left_ventricle_blood",
                                  "right_ventricle_blood",
                                  "left_atrium_blood",
                                  "right_atrium_blood",
                                  "mitral_valve",
                                  "tricuspid_valve",
                                  "aortic_valve",
                                  "papillary_muscle_lv_anterolateral",
                                  "papillary_muscle_lv_posteromedial",
                                  "papillary_muscle_rv",
                                  "aorta_lumen",
                                  "aorta_wall",
                                  "liver",
                                  "stomach",
                                  "visceral_fat_abdomen" };
  for (int rib = 1; rib <= 10; ++rib)
  {
    expected.insert("rib_left_" + std::to_string(rib));
    expected.insert("rib_right_" + std::to_string(rib));
  }
  for (const int spacing : { 1, 2 })
  {
    std::set<std::string> found;
    int previous = -1;
    for (const LabelInfo& label : thorax(spacing).labels)
    {
      EXPECT_TRUE(found.insert(label.name).second) << label.name << " stands twice";
      EXPECT_TRUE(label.hasColor) << label.name;
      EXPECT_GT(label.id, previous);
      previous = label.id;
    }
    EXPECT_EQ(found, expected);
    std::set<int> ids(thorax(spacing).voxels.begin(), thorax(spacing).voxels.end());
    EXPECT_EQ(ids.size(), expected.size());
  }
}

TEST(ThoraxPhantom, OrgansHaveAdultVolumes)
{
  const std::map<std::string, std::pair<double, double>> rangesMl{
    { "left_ventricle_blood", { 80.0, 160.0 } },
    { "right_ventricle_blood", { 80.0, 170.0 } },
    { "left_atrium_blood", { 30.0, 90.0 } },
    { "right_atrium_blood", { 40.0, 110.0 } },
    { "left_ventricle_myocardium", { 60.0, 130.0 } },
    { "interventricular_septum", { 25.0, 60.0 } },
    { "right_ventricle_myocardium", { 25.0, 70.0 } },
    { "pericardium", { 30.0, 90.0 } },
    { "aorta_lumen", { 70.0, 200.0 } },
    { "lung_left", { 1000.0, 2500.0 } },
    { "lung_right", { 1000.0, 2800.0 } },
    { "liver", { 900.0, 2000.0 } },
  };
  const std::map<std::string, double> volumes = volumesMl(thorax(1));
  for (const auto& [name, range] : rangesMl)
  {
    EXPECT_GE(volumes.at(name), range.first) << name;
    EXPECT_LE(volumes.at(name), range.second) << name;
  }
}

TEST(ThoraxPhantom, IsTheSameAnatomyAtOneAndTwoMillimetres)
{
  const std::map<std::string, double> fine = volumesMl(thorax(1));
  const std::map<std::string, double> coarse = volumesMl(thorax(2));
  for (const auto& [name, volume] : fine)
  {
    EXPECT_NEAR(coarse.at(name) / volume, 1.0, 0.1) << name << ", " << volume << " ml at 1 mm";
  }
}

TEST(ThoraxPhantom, WallsAndValvesEncloseTheBlood)
{
  const std::map<std::string, std::set<std::string>> allowed{
    { "left_ventricle_blood",
      { "left_ventricle_myocardium", "interventricular_septum", "mitral_valve", "aortic_valve", "aorta_wall",
        "papillary_muscle_lv_anterolateral", "papillary_muscle_lv_posteromedial", "left_atrium_wall",
        "left_atrium_blood" } },
    { "right_ventricle_blood",
      { "right_ventricle_myocardium", "interventricular_septum", "left_ventricle_myocardium", "tricuspid_valve",
        "papillary_muscle_rv", "right_atrium_wall", "right_atrium_blood", "aorta_wall" } },
    { "left_atrium_blood",
      { "left_atrium_wall", "interatrial_septum", "mitral_valve", "left_ventricle_myocardium",
        "interventricular_septum", "aorta_wall", "left_ventricle_blood" } },
    { "right_atrium_blood",
      { "right_atrium_wall", "interatrial_septum", "tricuspid_valve", "right_ventricle_myocardium",
        "left_ventricle_myocardium", "interventricular_septum", "aorta_wall", "right_ventricle_blood" } },
  };
  for (const int spacing : { 1, 2 })
  {
    for (const auto& [a, b] : neighbours(thorax(spacing)))
    {
      const auto chamber = allowed.find(a);
      if (chamber != allowed.end())
      {
        EXPECT_TRUE(chamber->second.count(b)) << a << " touches " << b << " at " << spacing << " mm";
      }
    }
  }
}

TEST(ThoraxPhantom, EachChamberIsOnePiece)
{
  for (const LabelInfo& label : thorax(1).labels)
  {
    const bool blood = label.name.find("_blood") != std::string::npos || label.name == "aorta_lumen";
    if (blood && label.name != "aorta_lumen") // the aorta leaves the volume at its lower face
    {
      EXPECT_GT(largestPart(thorax(1), label.id), 0.995) << label.name;
    }
  }
}

TEST(ThoraxPhantom, BoneDoesNotTouchTheHeart)
{
  for (const auto& [a, b] : neighbours(thorax(1)))
  {
    if (isBone(a))
    {
      EXPECT_TRUE(b.find("_blood") == std::string::npos && b.find("myocardium") == std::string::npos &&
                  b.find("atrium") == std::string::npos)
        << a << " touches " << b;
    }
  }
}

TEST(ThoraxPhantom, A4CPoseIsOrthonormalAndOnTheSkin)
{
  const ProbePose pose = thoraxPhantomA4C();
  EXPECT_NEAR(glm::length(pose.axial), 1.0, 1e-12);
  EXPECT_NEAR(glm::length(pose.lateral), 1.0, 1e-12);
  EXPECT_NEAR(glm::dot(pose.axial, pose.lateral), 0.0, 1e-12);
  EXPECT_GT(pose.lateral.x, 0.5) << "lateral points to the patient's left";
  EXPECT_EQ(nameAt(thorax(1), pose.positionMm), "skin");
  const Vec3d outward = glm::normalize(Vec3d(pose.positionMm.x, pose.positionMm.y, 0.0));
  double airMm = 0.0;
  while (nameAt(thorax(1), pose.positionMm + airMm * outward) != "background")
  {
    airMm += 0.05;
  }
  EXPECT_LE(airMm, 1.0 + std::sqrt(0.75)) << "1 mm, and half a voxel's diagonal for the map's staircase";
}

TEST(ThoraxPhantom, A4CAxisMeetsTheLayersInOrder)
{
  const ProbePose pose = thoraxPhantomA4C();
  std::vector<std::string> met;
  double epicardiumMm = 0.0;
  double leftAtriumEndMm = 0.0;
  for (double r = 0.0; r < 155.0; r += 0.1)
  {
    const std::string name = nameAt(thorax(1), pose.positionMm + r * pose.axial);
    if (met.empty() || met.back() != name)
    {
      met.push_back(name);
    }
    if (epicardiumMm == 0.0 && name == "left_ventricle_myocardium")
    {
      epicardiumMm = r;
    }
    if (name == "left_atrium_blood")
    {
      leftAtriumEndMm = r;
    }
  }
  const std::vector<std::string> expected{ "skin",
                                           "subcutaneous_fat",
                                           "muscle",
                                           "mediastinal_fat",
                                           "pericardium",
                                           "mediastinal_fat",
                                           "left_ventricle_myocardium",
                                           "left_ventricle_blood",
                                           "left_atrium_blood",
                                           "left_atrium_wall",
                                           "mediastinal_fat",
                                           "pericardium",
                                           "mediastinal_fat" };
  EXPECT_EQ(met, expected);
  EXPECT_GE(epicardiumMm, 20.0);
  EXPECT_LE(epicardiumMm, 30.0);
  EXPECT_LE(leftAtriumEndMm, 150.0);
}

TEST(ThoraxPhantom, A4CPlaneCutsBothValvesOnTheirSides)
{
  const ProbePose pose = thoraxPhantomA4C();
  std::map<std::string, double> lateralSum;
  std::map<std::string, int> count;
  for (double lateral = -80.0; lateral <= 60.0; lateral += 0.5)
  {
    for (double depth = 20.0; depth <= 155.0; depth += 0.5)
    {
      const std::string name = nameAt(thorax(1), pose.positionMm + lateral * pose.lateral + depth * pose.axial);
      lateralSum[name] += lateral;
      ++count[name];
    }
  }
  const auto mean = [&](const char* name) { return lateralSum[name] / count[name]; };
  EXPECT_NEAR(mean("mitral_valve"), 0.0, 4.0);
  EXPECT_LT(mean("tricuspid_valve"), -30.0);
  EXPECT_LT(mean("right_ventricle_blood"), mean("interventricular_septum"));
  EXPECT_LT(mean("interventricular_septum"), mean("left_ventricle_blood"));
  EXPECT_LT(mean("left_ventricle_blood"), mean("left_ventricle_myocardium"));
  EXPECT_LT(mean("right_atrium_blood"), mean("interatrial_septum"));
  EXPECT_LT(mean("interatrial_septum"), mean("left_atrium_blood"));
}

TEST(ThoraxPhantom, A4CFanShowsFourChambersAndLittleLung)
{
  std::map<std::string, double> shares = fanShares(45.0, 160.0);
  for (const char* side : { "left", "right" })
  {
    for (const char* chamber : { "ventricle", "atrium" })
    {
      const std::string name = std::string(side) + "_" + chamber + "_blood";
      EXPECT_GT(shares[name], 0.06) << name;
    }
  }
  EXPECT_LE(shares["lung_left"] + shares["lung_right"], 0.20);
}

TEST(ThoraxPhantom, NoBoneInTheNearCentreOfTheA4CFan)
{
  for (const auto& [name, share] : fanShares(30.0, 40.0))
  {
    EXPECT_FALSE(isBone(name)) << name;
  }
}

TEST(ThoraxPhantom, RejectsASpacingOutsideItsRange)
{
  for (const double spacing : { 0.0, -1.0, 0.49, 5.01, std::numeric_limits<double>::quiet_NaN() })
  {
    try
    {
      makeThoraxPhantom(spacing);
      FAIL() << spacing << " mm was taken";
    }
    catch (const Error& error)
    {
      EXPECT_NE(std::string(error.what()).find("0.5 to 5 mm"), std::string::npos) << error.what();
    }
  }
}

} // namespace
