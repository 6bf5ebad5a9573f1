#include "ErrorText.h"
#include "Folders.h"
#include "Labels/AssignTissues.h"
#include "Labels/TissueTable.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;

namespace {

const std::string header =
  "tissue,impedance_MRayl,sound_speed_m_per_s,attenuation_dB_per_cm_MHz,mu0,sigma0,mu1,tau,gamma,"
  "source\n";

class TextFile
{
public:
  explicit TextFile(const std::string& content) { std::ofstream(path(), std::ios::binary) << content; }
  std::string path() const { return folder_.file("table.csv"); }

private:
  sono::testing::TemporaryFolder folder_;
};

std::string tableError(const std::string& content)
{
  const TextFile file(content);
  return errorOf([&] { TissueTable::read(file.path()); });
}

TissueTable bundledTable()
{
  return TissueTable::read(dataFile("tissues.csv"));
}

LabelTissueMap bundledMap()
{
  return LabelTissueMap::read(dataFile("label_tissues.csv"));
}

double reflection(const Tissue* a, const Tissue* b)
{
  return std::abs(b->impedanceMRayl - a->impedanceMRayl) / (a->impedanceMRayl + b->impedanceMRayl);
}

} // namespace

TEST(TissueTable, ReadsColumnsInAnyOrder)
{
  const TextFile file(
    "# comment\n\nsource,tissue,gamma,tau,mu1,sigma0,mu0,attenuation_dB_per_cm_MHz,sound_speed_m_per_s,"
    "impedance_MRayl\r\n\"a, b \"\"c\"\"\",x,-2,3,0.1,0.2,0.3,0.4,1500,1.5\r\n");
  const TissueTable table = TissueTable::read(file.path());
  const Tissue* tissue = table.find("x");
  ASSERT_NE(tissue, nullptr);
  EXPECT_DOUBLE_EQ(tissue->impedanceMRayl, 1.5);
  EXPECT_DOUBLE_EQ(tissue->soundSpeedMPerS, 1500.0);
  EXPECT_DOUBLE_EQ(tissue->attenuationDbPerCmMHz, 0.4);
  EXPECT_DOUBLE_EQ(tissue->scattererMean, 0.3);
  EXPECT_DOUBLE_EQ(tissue->scattererSigma, 0.2);
  EXPECT_DOUBLE_EQ(tissue->scattererProbability, 0.1);
  EXPECT_DOUBLE_EQ(tissue->tau, 3.0);
  EXPECT_DOUBLE_EQ(tissue->gamma, -2.0);
  EXPECT_EQ(tissue->source, "a, b \"c\"");
  EXPECT_EQ(table.find("y"), nullptr);
}

TEST(TissueTable, ErrorsNameFileTissueAndColumn)
{
  const std::pair<const char*, const char*> rows[] = {
    { "bad,0,1500,0.5,0,0,0,1,0,s", "impedance_MRayl" },
    { "bad,nan,1500,0.5,0,0,0,1,0,s", "impedance_MRayl" },
    { "bad,1.5,0,0.5,0,0,0,1,0,s", "sound_speed_m_per_s" },
    { "bad,1.5,inf,0.5,0,0,0,1,0,s", "sound_speed_m_per_s" },
    { "bad,1.5,1.54,0.5,0,0,0,1,0,s", "sound_speed_m_per_s" }, // mm/us
    { "bad,1.5,1e6,0.5,0,0,0,1,0,s", "sound_speed_m_per_s" },
    { "bad,1e-5,1500,0.5,0,0,0,1,0,s", "impedance_MRayl" },
    { "bad,1.5e6,1500,0.5,0,0,0,1,0,s", "impedance_MRayl" }, // Rayl
    { "bad,1.5,1500,-0.1,0,0,0,1,0,s", "attenuation_dB_per_cm_MHz" },
    { "bad,1.5,1500,,0,0,0,1,0,s", "attenuation_dB_per_cm_MHz" },
    { "bad,1.5,1500,0.5,1.1,0,0,1,0,s", "mu0" },
    { "bad,1.5,1500,0.5,0,-0.1,0,1,0,s", "sigma0" },
    { "bad,1.5,1500,0.5,0,0,2,1,0,s", "mu1" },
    { "bad,1.5,1500,0.5,0,0,0,3.1,0,s", "tau" },
    { "bad,1.5,1500,0.5,0,0,0,1,-2.1,s", "gamma" },
    { "bad,1.5x,1500,0.5,0,0,0,1,0,s", "impedance_MRayl" },
  };
  for (const auto& [row, column] : rows)
  {
    const std::string error = tableError(header + row + "\n");
    expectContains(error, "table.csv' line 2");
    expectContains(error, "'bad'");
    expectContains(error, "'" + std::string(column) + "'");
  }
  const std::string good = "x,1.5,1500,0.5,0,0,0,1,0,s\n";
  EXPECT_EQ(tableError(header + good), "no error");
  expectContains(tableError(header + good + good), "'x' is there twice");
  expectContains(tableError(header + ",1.5,1500,0.5,0,0,0,1,0,s\n"), "no name");
  expectContains(tableError(header), "holds no tissue");
  expectContains(tableError("tissue,source\nx,y\n"), "no column 'impedance_MRayl'");
  expectContains(errorOf([] { TissueTable::read("no_such_table.csv"); }), "'no_such_table.csv': no such file");
}

TEST(TissueTable, BundledValuesAreSane)
{
  const TissueTable table = bundledTable();
  for (const char* name :
       { "water",       "gel",    "air",         "lung",   "fat",    "muscle",        "myocardium",
         "blood",       "skin",   "liver",       "spleen", "kidney", "cortical_bone", "cartilage",
         "vessel_wall", "valve",  "pericardium", "nerve",  "gland",  "gi_tract",      "connective_tissue",
         "soft_tissue", "lesion", "metal" })
  {
    ASSERT_NE(table.find(name), nullptr) << name;
    EXPECT_FALSE(table.find(name)->source.empty()) << name;
    EXPECT_DOUBLE_EQ(table.find(name)->tau, 1.0);
    EXPECT_DOUBLE_EQ(table.find(name)->gamma, 0.0);
  }
  const auto ofPhantom = [](const Tissue& tissue) { return tissue.name.rfind("phantom_", 0) == 0; };
  EXPECT_EQ(std::count_if(table.tissues().begin(), table.tissues().end(), ofPhantom), 10);
  EXPECT_EQ(table.tissues().size(), 38u);
  // Textbook reflections at normal incidence.
  EXPECT_NEAR(reflection(table.find("liver"), table.find("cortical_bone")), 0.651, 0.0005);
  EXPECT_NEAR(reflection(table.find("fat"), table.find("liver")), 0.089, 0.0005);
  EXPECT_NEAR(reflection(table.find("blood"), table.find("liver")), 0.0123, 0.0001);
  EXPECT_GT(reflection(table.find("muscle"), table.find("lung")), 0.75);
  // Density = Z / c; a slip of a factor of ten in either shows here.
  for (const Tissue& tissue : table.tissues())
  {
    const double density = 1e6 * tissue.impedanceMRayl / tissue.soundSpeedMPerS;
    const bool gas = tissue.name == "air" || tissue.name == "lung";
    const double heaviest = tissue.name == "metal" ? 4600.0 : 2000.0;
    EXPECT_TRUE(gas || (density > 900.0 && density < heaviest)) << tissue.name << " " << density;
  }
}

TEST(LabelTissueMap, Patterns)
{
  LabelTissueMap map;
  map.add({ "rib_*_1", "first" });
  map.add({ "Rib left", "bone" });
  map.add({ "*ventric*wall*", "wall" });
  map.add({ "*cava", "vein" });
  map.add({ "arter*", "artery" });
  map.add({ "Exact", "exact" });
  EXPECT_EQ(map.find("rib_left_1"), "first");
  EXPECT_EQ(map.find("RIB_LEFT_1_1"), "first");
  EXPECT_EQ(map.find("1st left rib"), "first");
  EXPECT_EQ(map.find("rib_left_11"), "bone");
  EXPECT_EQ(map.find("left ribs"), "bone");
  EXPECT_EQ(map.find("rib"), "");
  EXPECT_EQ(map.find("xrib left"), "");
  EXPECT_EQ(map.find("wall of the intraventricular"), "wall");
  EXPECT_EQ(map.find("ventricle"), "");
  EXPECT_EQ(map.find("vena cava"), "vein");
  EXPECT_EQ(map.find("postcava"), "vein");
  EXPECT_EQ(map.find("caval"), "");
  EXPECT_EQ(map.find("arterial"), "artery");
  EXPECT_EQ(map.find("endarterial"), "");
  EXPECT_EQ(map.find("exact"), "exact");
  EXPECT_EQ(map.find("(exact) "), "exact");
  EXPECT_EQ(map.find("exactly"), "");
  EXPECT_EQ(map.find(""), "");
  LabelTissueMap any;
  any.add({ "**", "all" });
  EXPECT_EQ(any.find(""), "all");
}

TEST(LabelTissueMap, FileErrors)
{
  const TextFile lacking("pattern,tissue\na,b\nc,\n");
  expectContains(errorOf([&] { LabelTissueMap::read(lacking.path()); }), "table.csv' line 3");
  const TextFile guess("pattern,tissue,guess\na,b,perhaps\n");
  expectContains(errorOf([&] { LabelTissueMap::read(guess.path()); }), "'perhaps' in column 'guess'");
  const TextFile columns("label,tissue\na,b\n");
  expectContains(errorOf([&] { LabelTissueMap::read(columns.path()); }), "no column 'pattern'");
}

TEST(AssignTissues, FillsWhatIsEmpty)
{
  LabelVolume volume;
  volume.voxels = { 0, 1, 2, 3 };
  volume.collectLabels();
  volume.labels[1].name = "rib_left_4";
  volume.labels[2].name = "thing";
  volume.labels[3].tissue = "fat";
  const std::vector<std::string> unmatched = assignTissues(volume, bundledMap(), bundledTable(), "soft_tissue");
  EXPECT_EQ(unmatched, std::vector<std::string>{ "thing" });
  EXPECT_EQ(volume.labels[0].tissue, "air");
  EXPECT_EQ(volume.labels[1].tissue, "cortical_bone");
  EXPECT_EQ(volume.labels[2].tissue, "soft_tissue");
  EXPECT_EQ(volume.labels[3].tissue, "fat");
}

TEST(AssignTissues, UnknownTissuesAreNamed)
{
  LabelVolume volume;
  volume.voxels = { 4 };
  volume.collectLabels();
  LabelTissueMap map;
  map.add({ "label_4", "cheese" });
  const std::string error = errorOf([&] { assignTissues(volume, map, bundledTable(), "fat"); });
  expectContains(error, "'cheese'");
  expectContains(error, "'label_4'");
  EXPECT_TRUE(volume.labels[0].tissue.empty());
  expectContains(errorOf([&] { assignTissues(volume, map, bundledTable(), "wood"); }), "'wood'");
}

TEST(AssignTissues, EveryBundledPatternLeadsToATissue)
{
  const TissueTable table = bundledTable();
  const LabelTissueMap map = bundledMap();
  for (const LabelTissueRule& rule : map.rules())
  {
    EXPECT_NE(table.find(rule.tissue), nullptr) << rule.pattern << rule.code << " -> " << rule.tissue;
  }
}

TEST(AssignTissues, WellKnownNames)
{
  const LabelTissueMap map = bundledMap();
  const std::pair<const char*, const char*> names[] = {
    { "outside_air", "air" },
    { "background", "air" },
    { "skin", "skin" },
    { "fat", "fat" },
    { "muscle", "muscle" },
    { "blood", "blood" },
    { "myocardium", "myocardium" },
    { "heart_myocardium", "myocardium" },
    { "heart", "myocardium" },
    { "heart_ventricle_left", "blood" },
    { "heart_atrium_right", "blood" },
    { "aorta", "blood" },
    { "left ventricle wall", "myocardium" },
    { "iliac_vena_left", "blood" },
    { "atrial_appendage_left", "blood" },
    { "vertebrae_L3", "cortical_bone" },
    { "hip_left", "cortical_bone" },
    { "lung_vessels", "blood" },
    { "cervical vertebral column", "cortical_bone" },
    { "right lung", "lung" },
    { "urinary_bladder", "water" },
    { "skeletal_muscle", "muscle" },
    { "subcutaneous_fat", "fat" },
    { "gluteus_maximus_left", "muscle" },
    { "brain", "nerve" },
    { "duodenum", "gi_tract" },
    { "prostate", "gland" },
    { "kidney_cyst_left", "water" },
  };
  for (const auto& [name, tissue] : names)
  {
    EXPECT_EQ(map.find(name), tissue) << name;
  }
}

TEST(AssignTissues, AgreesWithTheClassesOfTheHeartData)
{
  std::ifstream csv(sharedDataFolder() + "/thorax_heart/labels.csv");
  if (!csv)
  {
    GTEST_SKIP() << "the thorax_heart data are not there";
  }
  const std::map<std::string, std::string> ours = { { "outside", "air" },
                                                    { "air_gas", "air" },
                                                    { "gi_wall_and_content", "gi_tract" },
                                                    { "nerve_cns", "nerve" },
                                                    { "gland_soft_tissue", "gland" } };
  const LabelTissueMap map = bundledMap();
  std::string line;
  std::getline(csv, line);
  int count = 0;
  for (; std::getline(csv, line); ++count)
  {
    std::istringstream fields(line);
    std::string id, name, tissueClass;
    std::getline(std::getline(std::getline(fields, id, ','), name, ','), tissueClass, ',');
    const auto renamed = ours.find(tissueClass);
    EXPECT_EQ(map.find(name), renamed == ours.end() ? tissueClass : renamed->second) << name;
  }
  EXPECT_GE(count, 104);
}

TEST(AssignTissues, KnowsEveryNameOfATotalSegmentatorMap)
{
  std::ifstream list(sharedDataFolder() + "/totalseg_s0327/s0327_labels.txt");
  if (!list)
  {
    GTEST_SKIP() << "the totalseg_s0327 data are not there";
  }
  const LabelTissueMap map = bundledMap();
  std::string line;
  std::getline(list, line); // a remark
  int count = 0;
  for (; std::getline(list, line); ++count)
  {
    std::istringstream fields(line);
    std::string id, name;
    fields >> id >> name;
    EXPECT_NE(map.find(name), "") << name;
  }
  EXPECT_GE(count, 100);
}
