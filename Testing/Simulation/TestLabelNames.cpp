#include "Labels/AssignTissues.h"
#include "Labels/CsvFile.h"
#include "Labels/KnownNumbers.h"
#include "Labels/LabelCode.h"
#include "Labels/LabelWords.h"

#include "ErrorText.h"
#include "Folders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

using namespace sono;

namespace {

using Words = std::vector<std::string>;

const LabelTissueMap& bundledRules()
{
  static const LabelTissueMap map = LabelTissueMap::read(dataFile("label_tissues.csv"));
  return map;
}

const CsvFile& publicNames()
{
  static const CsvFile names = CsvFile::read(labelNamesFile());
  return names;
}

LabelVolume volumeOf(const std::vector<LabelInfo>& labels)
{
  LabelVolume volume;
  for (const LabelInfo& label : labels)
  {
    volume.voxels.push_back(std::uint16_t(label.id));
  }
  volume.labels = labels;
  volume.collectLabels();
  return volume;
}

LabelInfo labelOf(int id, const std::string& name, const std::string& code = "")
{
  LabelInfo label;
  label.id = id;
  label.name = name;
  label.code = code;
  return label;
}

std::string joined(const Words& words, const std::string& between)
{
  std::string text;
  for (const std::string& word : words)
  {
    text += (text.empty() ? "" : between) + word;
  }
  return text;
}

} // namespace

TEST(LabelWords, AreWhatAPersonReads)
{
  const std::pair<const char*, Words> names[] = {
    { "left rib 6", { "left", "rib", "6" } },
    { "rib_left_6", { "rib", "left", "6" } },
    { "Rib 6 (left)", { "rib", "6", "left" } },
    { "RibLeft6", { "rib", "left", "6" } },
    { "CTLiver", { "ct", "liver" } },
    { "KIDNEY-L", { "kidney", "l" } },
    { "vertebrae_T12", { "vertebra", "t", "12" } },
    { "arteries of bodies", { "artery", "of", "body" } },
    { "sinuses/ribs", { "sinus", "rib" } },
    { "uterus pelvis mass gas", { "uterus", "pelvis", "mass", "gas" } },
    { "H\xC3\xBC"
      "fte",
      { "h\xC3\xBC"
        "fte" } },
    { "", {} },
    { " _-()", {} },
  };
  for (const auto& [name, words] : names)
  {
    EXPECT_EQ(wordsOfName(name), words) << name;
  }
}

TEST(LabelNames, EveryNameOfThePublicListsHasItsTissue)
{
  const CsvFile& names = publicNames();
  const auto source = std::size_t(names.requiredColumn("source"));
  const auto name = std::size_t(names.requiredColumn("name"));
  const auto tissue = std::size_t(names.requiredColumn("tissue"));
  for (const CsvFile::Row& row : names.rows)
  {
    EXPECT_EQ(bundledRules().find(row.fields[name]), row.fields[tissue])
      << row.fields[source] << ": " << row.fields[name] << ", line " << row.line;
  }
  EXPECT_GE(names.rows.size(), 2000u);
}

TEST(LabelNames, OrderCaseAndSeparatorsDoNotMatter)
{
  const CsvFile& names = publicNames();
  const auto name = std::size_t(names.requiredColumn("name"));
  const auto tissue = std::size_t(names.requiredColumn("tissue"));
  for (const CsvFile::Row& row : names.rows)
  {
    const std::string& text = row.fields[name];
    Words words = wordsOfName(text);
    std::reverse(words.begin(), words.end());
    EXPECT_EQ(bundledRules().find(joined(words, "_")), row.fields[tissue]) << text;
    EXPECT_EQ(bundledRules().find("[" + joined(words, ".") + "]"), row.fields[tissue]) << text;
    std::string capitals = joined(words, "-");
    std::transform(capitals.begin(), capitals.end(), capitals.begin(), [](unsigned char c) { return std::toupper(c); });
    EXPECT_EQ(bundledRules().find(capitals), row.fields[tissue]) << text;
  }
}

TEST(LabelNames, BonesAndLungsNeverBecomeSoftTissue)
{
  // Whatever else the name says: each of these words together with the words of every rule.
  const Words hard = { "rib",     "ribs",   "bone",    "bones",    "vertebra", "vertebrae", "lung",  "lungs",
                       "sacrum",  "skull",  "sternum", "scapula",  "femur",    "hip",       "tibia", "fibula",
                       "humerus", "radius", "ulna",    "clavicle", "mandible", "patella",   "spine", "costa" };
  for (const std::string& word : hard)
  {
    EXPECT_TRUE(bundledRules().find(word) == "cortical_bone" || bundledRules().find(word) == "lung") << word;
    for (const LabelTissueRule& rule : bundledRules().rules())
    {
      const std::string tissue = bundledRules().find(word + " " + rule.pattern);
      EXPECT_NE(tissue, "soft_tissue") << word << " " << rule.pattern;
      EXPECT_NE(tissue, "") << word << " " << rule.pattern;
    }
  }
}

TEST(LabelNames, BonesAndLungsAreSeenInWordsThatRunTogether)
{
  for (const std::string word : { "rib", "bone", "vertebra", "lung", "skull", "sternum", "scapula", "femur" })
  {
    const std::string tissue = bundledRules().find(word);
    EXPECT_EQ(bundledRules().find("left" + word), tissue) << word;
    EXPECT_EQ(bundledRules().find(word + "left6"), tissue) << word;
    EXPECT_EQ(bundledRules().find("LEFT" + word + "6"), tissue) << word;
  }
}

TEST(LabelNames, ARuleMayAskForAPersonsEye)
{
  LabelVolume volume =
    volumeOf({ labelOf(0, "Unknown"), labelOf(1, "left rib 6"), labelOf(2, "thing"), labelOf(3, "ventricle") });
  const TissueTable tissues = TissueTable::read(dataFile("tissues.csv"));
  EXPECT_EQ(assignTissues(volume, bundledRules(), tissues, "soft_tissue"), Words{ "thing" });
  EXPECT_EQ(volume.find(0)->tissue, "air");
  EXPECT_FALSE(volume.find(0)->guessed || volume.find(1)->guessed);
  EXPECT_TRUE(volume.find(2)->guessed);
  EXPECT_EQ(volume.find(2)->tissue, "soft_tissue");
  EXPECT_TRUE(volume.find(3)->guessed); // the heart's or the brain's
  EXPECT_EQ(volume.find(3)->tissue, "water");
}

TEST(LabelCodes, CountBeforeNames)
{
  LabelVolume volume =
    volumeOf({ labelOf(1, "Segment_1", "SCT 64033007"), labelOf(2, "mine", "SRT T-62000"), labelOf(3, "liver", "SCT 1"),
               labelOf(4, "vein", "SCT 113197003"), labelOf(5, "Rippe", "SCT 59558009") });
  const TissueTable tissues = TissueTable::read(dataFile("tissues.csv"));
  EXPECT_TRUE(assignTissues(volume, bundledRules(), tissues, "air").empty());
  const Words expected = { "kidney", "liver", "liver", "cortical_bone", "cortical_bone" };
  for (int id = 1; id <= 5; ++id)
  {
    EXPECT_EQ(volume.find(id)->tissue, expected[std::size_t(id - 1)]) << id;
    EXPECT_FALSE(volume.find(id)->guessed) << id;
  }
}

TEST(LabelCodes, KnowTheTerminologies)
{
  // From DICOM's context groups 7154, 7155, 7166 and the table that comes with TotalSegmentator.
  const std::pair<const char*, const char*> codes[] = {
    { "SCT 10200004", "liver" },        { "SRT T-62000", "liver" },         { "SCT 78961009", "spleen" },
    { "SRT T-C3000", "spleen" },        { "SCT 39607008", "lung" },         { "SRT T-28000", "lung" },
    { "SCT 80891009", "myocardium" },   { "SCT 15825003", "blood" },        { "SRT T-42000", "blood" },
    { "SCT 3138006", "cortical_bone" }, { "SRT T-D016E", "cortical_bone" }, { "SCT 122494005", "cortical_bone" },
    { "SCT 55603005", "fat" },          { "SCT 39937001", "skin" },         { "SCT 2748008", "nerve" },
    { "SCT 44567001", "air" },          { "SCT 108369006", "lesion" },      { "SCT 40388003", "metal" },
    { "SCT 122972007", "blood" },       { "SCT 68455001", "muscle" },       { "SCT 28231008", "water" },
  };
  for (const auto& [code, tissue] : codes)
  {
    const LabelTissueRule* rule = bundledRules().matchCode(code);
    ASSERT_NE(rule, nullptr) << code;
    EXPECT_EQ(rule->tissue, tissue) << code;
  }
  EXPECT_EQ(bundledRules().matchCode("SCT 85756007"), nullptr); // "Tissue", which Slicer gives to what has no other
  EXPECT_EQ(bundledRules().matchCode(""), nullptr);
}

TEST(LabelCodes, NameWhatHasNoName)
{
  const CodedConcept kidney{ "SCT", "64033007", "Kidney" };
  LabelInfo label = labelOf(1, "Segment_1");
  describeByCode(kidney, { "SCT", "7771000", "Left" }, label);
  EXPECT_EQ(label.name, "left kidney");
  EXPECT_EQ(label.code, "SCT 64033007");
  label = labelOf(1, "tumour");
  describeByCode({ "99SDM", "T-71000", "Kidney" }, {}, label);
  EXPECT_EQ(label.name, "tumour");
  EXPECT_EQ(label.code, "SRT T-71000");
  describeByCode({}, {}, label);
  EXPECT_EQ(label.code, "SRT T-71000");
  label = labelOf(1, "Segment_2");
  describeByCode({ "SCT", "85756007", "Tissue" }, {}, label);
  EXPECT_EQ(label.name, "Segment_2");
  EXPECT_TRUE(saysNothing("") && saysNothing("label 7") && saysNothing("12") && !saysNothing("rib 7"));
}

TEST(LabelCodes, StandInSlicersTags)
{
  const std::string tags =
    "Segmentation.Status:inprogress|TerminologyEntry:Segmentation category and type - 3D Slicer General Anatomy list"
    "~SCT^123037004^Anatomical Structure~SCT^39607008^Lung~SCT^24028007^Right~Anatomic codes - DICOM master "
    "list~^^~^^|";
  LabelInfo label = labelOf(1, "");
  describeBySlicerTags(tags, label);
  EXPECT_EQ(label.code, "SCT 39607008");
  EXPECT_EQ(label.name, "right lung");
  for (const char* none : { "", "|", "TerminologyEntry:", "TerminologyEntry:a~b~c~", "TerminologyEntry:~~^^~^^|~" })
  {
    label = labelOf(1, "Segment_1");
    describeBySlicerTags(none, label);
    EXPECT_EQ(label.name, "Segment_1") << none;
    EXPECT_EQ(label.code, "") << none;
  }
}

TEST(KnownNumbers, NameAHeartAndNothingElse)
{
  const auto namesOf = [](const std::vector<int>& ids, const std::string& name = "") {
    std::vector<LabelInfo> labels = { labelOf(0, "") };
    for (const int id : ids)
    {
      labels.push_back(labelOf(id, name));
    }
    LabelVolume volume = volumeOf(labels);
    nameKnownNumbers(volume);
    return volume.labels;
  };
  const std::vector<LabelInfo> heart = namesOf({ 205, 420, 500, 550, 600, 820, 850 });
  const Words tissues = { "air", "myocardium", "blood", "blood", "blood", "blood", "blood", "blood" };
  for (std::size_t n = 0; n < heart.size(); ++n)
  {
    EXPECT_EQ(bundledRules().find(heart[n].name), tissues[n]) << heart[n].name;
  }
  EXPECT_EQ(namesOf({ 205, 500 })[1].name, "label_205");         // too few to be sure
  EXPECT_EQ(namesOf({ 205, 500, 600, 7 })[3].name, "label_500"); // another list
  EXPECT_EQ(namesOf({ 205, 500, 600 }, "mine")[1].name, "mine");
  EXPECT_EQ(namesOf({ 51, 52, 53 })[1].name, "label_51");
}
