#include "ErrorText.h"
#include "Probe/PulseEchoFieldFile.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <type_traits>
#include <vector>

namespace fs = std::filesystem;
using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;

namespace {

const float notANumber = std::numeric_limits<float>::quiet_NaN();

/// A function that trilinear interpolation reproduces; 1 at its largest, at (2, 3, 30).
double trilinear(double l, double e, double d)
{
  return (1.0 + 0.2 * l) * (2.0 + e) * (d + 4.0) / (1.4 * 5.0 * 34.0);
}

const FieldGrid grid{ { -1.0, 0.5, 7 }, { -2.0, 1.0, 6 }, { 10.0, 4.0, 6 } };

std::vector<float> trilinearValues(double scale)
{
  std::vector<float> values;
  for (int d = 0; d < grid.depth.count; ++d)
  {
    for (int e = 0; e < grid.elevational.count; ++e)
    {
      for (int l = 0; l < grid.lateral.count; ++l)
      {
        values.push_back(float(scale * trilinear(grid.lateral.at(l), grid.elevational.at(e), grid.depth.at(d))));
      }
    }
  }
  return values;
}

/// A file as somebody else's program writes it.
class FieldFile : public ::testing::Test
{
protected:
  void write(const std::string& header, const std::vector<double>& values) const
  {
    std::ofstream stream(path, std::ios::binary);
    stream << header;
    stream.write(reinterpret_cast<const char*>(values.data()), std::streamsize(8 * values.size()));
  }

  std::string refusal(const std::string& from, const std::string& to, const std::vector<double>& values) const
  {
    std::string header = good;
    header.replace(header.find(from), from.size(), to);
    write(header, values);
    const std::string message = errorOf([&] { readPulseEchoField(path); });
    expectContains(message, "field.nrrd");
    return message;
  }

  const sono::testing::TemporaryFolder folder;
  const std::string path = folder.file("field.nrrd");
  const std::string good = "NRRD0004\ntype: double\nendian: little\nencoding: raw\ndimension: 3\nsizes: 3 1 2\n"
                           "labels: \"lateral\" \"elevational\" \"depth\"\nunits: \"mm\" \"mm\" \"mm\"\n"
                           "axis mins: 0 0 5\nspacings: 0.5 1 10\n\n";
};

} // namespace

TEST(PulseEchoField, ViewTravelsAsBytes)
{
  static_assert(std::is_trivially_copyable<BeamFieldView>::value, "a kernel argument");
}

TEST(PulseEchoField, LookupIsTrilinear)
{
  const PulseEchoField field(grid, trilinearValues(1.0));
  for (double l = -1.0; l <= 2.0; l += 0.1249)
  {
    for (double e = -2.0; e <= 3.0; e += 0.3331)
    {
      for (double d = 10.0; d <= 30.0; d += 1.777)
      {
        EXPECT_NEAR(beamWeight(field.view(), float(l), float(e), float(d)), trilinear(l, e, d), 2e-6);
      }
    }
  }
  EXPECT_NEAR(beamWeight(field.view(), 2.0f, 3.0f, 30.0f), 1.0, 1e-6); // the last corner belongs to the table
}

TEST(PulseEchoField, OutsideIsDark)
{
  const PulseEchoField field(grid, trilinearValues(1.0));
  const BeamFieldView view = field.view();
  EXPECT_EQ(beamWeight(view, -1.01f, 0.0f, 20.0f), 0.0f);
  EXPECT_EQ(beamWeight(view, 2.01f, 0.0f, 20.0f), 0.0f);
  EXPECT_EQ(beamWeight(view, 0.0f, 3.01f, 20.0f), 0.0f);
  EXPECT_EQ(beamWeight(view, 0.0f, 0.0f, 9.99f), 0.0f);
  EXPECT_EQ(beamWeight(view, 0.0f, 0.0f, 30.01f), 0.0f);
  EXPECT_EQ(beamWeight(view, notANumber, 0.0f, 20.0f), 0.0f);
  EXPECT_EQ(beamWeight(view, 1e30f, 0.0f, 20.0f), 0.0f);
  EXPECT_EQ(field.lateralReachMm(), 2.0);
  EXPECT_EQ(field.elevationalReachMm(), 3.0);
}

TEST(PulseEchoField, HalvesAreMirroredAndOneValueFillsItsStep)
{
  const PulseEchoField field({ { 0.0, 1.0, 3 }, { 0.0, 2.0, 1 }, { 0.0, 10.0, 2 } },
                             { 4.0f, 2.0f, 1.0f, 2.0f, 1.0f, 0.0f });
  const BeamFieldView view = field.view();
  EXPECT_FLOAT_EQ(beamWeight(view, 0.0f, 0.0f, 0.0f), 1.0f);
  EXPECT_FLOAT_EQ(beamWeight(view, 0.5f, 0.9f, 0.0f), 0.75f);
  EXPECT_FLOAT_EQ(beamWeight(view, -0.5f, -0.9f, 0.0f), 0.75f);
  EXPECT_FLOAT_EQ(beamWeight(view, -1.5f, 0.0f, 5.0f), (0.375f + 0.125f) / 2.0f);
  EXPECT_EQ(beamWeight(view, 0.0f, 1.1f, 0.0f), 0.0f);
  EXPECT_EQ(field.elevationalReachMm(), 1.0);
}

TEST(PulseEchoField, LargestValueIsOne)
{
  const PulseEchoField field(grid, trilinearValues(1e-20));
  EXPECT_NEAR(beamWeight(field.view(), 0.3f, -1.2f, 17.0f), trilinear(0.3, -1.2, 17.0), 2e-6);
}

TEST(PulseEchoField, RefusesWhatIsNoField)
{
  const auto refusal = [](const FieldGrid& g, std::vector<float> values) {
    return errorOf([&] { PulseEchoField(g, values, "it"); });
  };
  FieldGrid wrong = grid;
  wrong.depth.stepMm = -1.0;
  expectContains(refusal(wrong, trilinearValues(1.0)), "it: the depth axis does not ascend");
  wrong = grid;
  wrong.depth.minMm = -1.0;
  expectContains(refusal(wrong, trilinearValues(1.0)), "behind the transducer");
  wrong = grid;
  wrong.lateral.minMm = 0.5;
  expectContains(refusal(wrong, trilinearValues(1.0)), "the lateral axis leaves out the beam's axis");
  wrong.lateral = { -10.0, 0.5, 7 };
  expectContains(refusal(wrong, trilinearValues(1.0)), "the lateral axis leaves out the beam's axis");
  wrong = grid;
  wrong.elevational.count = 0;
  expectContains(refusal(wrong, {}), "the elevational axis holds no position");
  wrong.elevational.count = 2000000000;
  expectContains(refusal(wrong, {}), "2^26");
  expectContains(refusal(grid, { 1.0f }), "1 values but its axes ask for 252");
  auto values = trilinearValues(1.0);
  values[1 + 7 * (2 + 6 * 3)] = notANumber;
  expectContains(refusal(grid, values), "lateral -0.5, elevational 0, depth 22 mm");
  values.assign(252, 0.0f);
  expectContains(refusal(grid, values), "zero everywhere");
  values[0] = -1.0f;
  expectContains(refusal(grid, values), "at least 0");
}

TEST_F(FieldFile, ReadsWhatOthersWrite)
{
  write(good, { 8e-60, 4e-60, 2e-60, 4e-60, 2e-60, 0.0 });
  const PulseEchoField field = readPulseEchoField(path);
  EXPECT_TRUE((field.grid() == FieldGrid{ { 0.0, 0.5, 3 }, { 0.0, 1.0, 1 }, { 5.0, 10.0, 2 } }));
  EXPECT_EQ(field.values(), (std::vector<float>{ 1.0f, 0.5f, 0.25f, 0.5f, 0.25f, 0.0f }));
}

TEST_F(FieldFile, WritesWhatItReads)
{
  const FieldGrid odd{ { 0.0, 1.0 / 3.0, 7 }, { -2.5, 1.0, 6 }, { 0.1, 0.7, 6 } };
  const PulseEchoField field(odd, trilinearValues(1.0));
  writePulseEchoField(field, path);
  const PulseEchoField again = readPulseEchoField(path);
  EXPECT_TRUE(again.grid() == odd);
  EXPECT_EQ(again.values(), field.values());
  expectContains(errorOf([&] { writePulseEchoField(field, "/no/such/folder/f.nrrd"); }), "/no/such/folder/f.nrrd");
}

TEST_F(FieldFile, ErrorsNameFileAndAxis)
{
  const std::vector<double> values{ 1.0, 0.5, 0.2, 0.5, 0.2, 0.1 };
  expectContains(refusal("0.5 1 10", "0.5 1 -10", values), "the depth axis does not ascend (its step is -10 mm)");
  expectContains(refusal("0.5 1 10", "0.5 nan 10", values), "the elevational axis has no finite step");
  expectContains(refusal("axis mins: 0 0 5\n", "", values), "the lateral axis has no finite start");
  expectContains(refusal("0 0 5", "0 0 -5", values), "the depth axis starts behind the transducer");
  expectContains(refusal("0 0 5", "1 0 5", values), "the lateral axis leaves out");
  expectContains(refusal("\"mm\" \"mm\" \"mm\"", "\"mm\" \"mm\" \"m\"", values), "the depth axis has the unit 'm'");
  expectContains(refusal("units: \"mm\" \"mm\" \"mm\"\n", "", values), "the lateral axis has the unit ''");
  expectContains(refusal("\"lateral\" \"elevational\"", "\"elevational\" \"lateral\"", values),
                 "the lateral axis is labelled 'elevational'");
  expectContains(refusal("units", "centers: cell cell cell\nunits", values), "the lateral axis is centred on cells");
  expectContains(refusal("sizes: 3 1 2", "sizes: 3 1 3", values), "no complete NRRD file");
  expectContains(refusal("double", "doubt", values), "no complete NRRD file");
  expectContains(refusal("spacings", "spacings", { 1.0, 0.5, notANumber, 0.5, 0.2, 0.1 }),
                 "lateral 1, elevational 0, depth 5 mm");
  expectContains(refusal("spacings", "spacings", { 1.0, 0.5, 0.5, 0.5, -0.2, 0.1 }),
                 "lateral 0.5, elevational 0, depth 15");
  expectContains(refusal("spacings", "spacings", { 1.0, 0.5, std::numeric_limits<double>::infinity(), 0.5, 0.2, 0.1 }),
                 "holds inf");
  write("NRRD0004\ntype: double\nendian: little\nencoding: raw\ndimension: 2\nsizes: 3 2\n\n", values);
  expectContains(errorOf([&] { readPulseEchoField(path); }), "has 2 axes");
  fs::remove(path);
  expectContains(errorOf([&] { readPulseEchoField(path); }), "no such file");
}
