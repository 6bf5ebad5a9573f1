#include "Folders.h"
#include "Labels/PrepareBody.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace sono;

const TissueTable& tissues()
{
  static const TissueTable table = TissueTable::read(dataFile("tissues.csv"));
  return table;
}

/// A block of one label in a box of air, 2 mm voxels; `shell` is the name of its outermost voxels.
LabelVolume block(const char* inside, const char* shell)
{
  constexpr int edge = 40;
  constexpr int margin = 5;
  LabelVolume volume;
  volume.placement.size = Vec3i(edge);
  volume.placement.spacingMm = Vec3d(2.0);
  for (int k = 0; k < edge; ++k)
  {
    for (int j = 0; j < edge; ++j)
    {
      for (int i = 0; i < edge; ++i)
      {
        const int depth = std::min({ i, j, k, edge - 1 - i, edge - 1 - j, edge - 1 - k }) - margin;
        volume.voxels.push_back(std::uint16_t(depth < 0 ? 0 : depth == 0 ? 2 : 1));
      }
    }
  }
  volume.collectLabels();
  for (LabelInfo& label : volume.labels)
  {
    label.name = label.id == 0 ? "background" : label.id == 1 ? inside : shell;
  }
  return volume;
}

int saying(const std::string& words, LabelVolume volume, BodyFillMode fill)
{
  const auto map = LabelTissueMap::read(dataFile("label_tissues.csv"));
  const std::vector<std::string> said = prepareBody(volume, map, tissues(), "soft_tissue", fill);
  return int(std::count_if(said.begin(), said.end(),
                           [&](const std::string& sentence) { return sentence.find(words) != std::string::npos; }));
}

TEST(PrepareBody, NoSkinIsSaidWhereNothingIsFilled)
{
  const char* words = "no skin and Fill Body is Off";
  EXPECT_EQ(saying(words, block("liver", "spleen"), BodyFillMode::Off), 1);
  EXPECT_EQ(saying(words, block("liver", "spleen"), BodyFillMode::Auto), 0);
  EXPECT_EQ(saying(words, block("liver", "skin"), BodyFillMode::Off), 0);
}

TEST(PrepareBody, WithoutFillingTheLabelsStay)
{
  LabelVolume volume = block("liver", "spleen");
  const std::vector<std::uint16_t> before = volume.voxels;
  prepareBody(volume, LabelTissueMap::read(dataFile("label_tissues.csv")), tissues(), "soft_tissue", BodyFillMode::Off);
  EXPECT_EQ(volume.voxels, before);
  EXPECT_EQ(volume.labels.size(), 3u);
}

TEST(PrepareBody, AHeartOfOneLabelIsSaidHoweverItIsFilled)
{
  for (const BodyFillMode fill : { BodyFillMode::Off, BodyFillMode::Auto })
  {
    EXPECT_EQ(saying("one label without blood", block("heart", "spleen"), fill), 1);
    EXPECT_EQ(saying("one label without blood", block("liver", "spleen"), fill), 0);
  }
}

} // namespace
