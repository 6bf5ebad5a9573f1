#include "Files/TrackedCine.h"

#include "Core/EndsWith.h"
#include "Core/Error.h"
#include "Files/GreyFrames.h"

#include <cstdio>

namespace sono {

namespace {

std::string decimal(double number)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.10g", number);
  return text;
}

/// A transform of four columns, row by row.
std::string matrixText(const Vec3d& x, const Vec3d& y, const Vec3d& z, const Vec3d& origin)
{
  std::string text;
  for (int row = 0; row < 3; ++row)
  {
    for (const Vec3d* column : { &x, &y, &z, &origin })
    {
      text += decimal((*column)[row]) + " ";
    }
  }
  return text + "0 0 0 1";
}

/// What there is to say of the frames, an entry a line, with what stands between name and value.
std::string framesText(const TrackedInfo& info, const std::string& between)
{
  const std::string imageToProbe = matrixText({ info.pixelMm[0], 0.0, 0.0 }, { 0.0, info.pixelMm[1], 0.0 },
                                              { 0.0, 0.0, info.pixelMm[0] }, { info.firstMm[0], info.firstMm[1], 0.0 });
  std::string text;
  for (std::size_t n = 0; n < info.poses.size(); ++n)
  {
    char name[32];
    std::snprintf(name, sizeof(name), "Seq_Frame%04zu_", n);
    const ProbePose& pose = info.poses[n];
    const auto add = [&](const std::string& key, const std::string& value) {
      text += name + key + between + value + "\n";
    };
    add("ImageToProbeTransform", imageToProbe);
    add("ImageToProbeTransformStatus", "OK");
    add("ProbeToReferenceTransform",
        matrixText(pose.lateral, pose.axial, glm::cross(pose.lateral, pose.axial), pose.positionMm));
    add("ProbeToReferenceTransformStatus", "OK");
    add("Timestamp", decimal(info.timesS[n]));
    add("ImageStatus", "OK");
  }
  return text;
}

std::string sizesText(const TrackedInfo& info)
{
  return std::to_string(info.width) + " " + std::to_string(info.height) + " " + std::to_string(info.poses.size());
}

std::string metaHeader(const TrackedInfo& info)
{
  return "ObjectType = Image\nNDims = 3\nAnatomicalOrientation = RAI\nBinaryData = True\n"
         "BinaryDataByteOrderMSB = False\nCenterOfRotation = 0 0 0\nCompressedData = False\nDimSize = " +
         sizesText(info) +
         "\nKinds = domain domain list\nElementNumberOfChannels = 1\nElementSpacing = 1 1 1\nElementType = MET_UCHAR\n"
         "Offset = 0 0 0\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nUltrasoundImageOrientation = MFA\n"
         "UltrasoundImageType = BRIGHTNESS\n" +
         framesText(info, " = ") + "ElementDataFile = LOCAL\n";
}

std::string nrrdHeader(const TrackedInfo& info)
{
  return "NRRD0004\ntype: uchar\ndimension: 3\nsizes: " + sizesText(info) +
         "\nkinds: domain domain list\nencoding: raw\nUltrasoundImageOrientation:=MFA\n"
         "UltrasoundImageType:=BRIGHTNESS\n" +
         framesText(info, ":=") + "\n";
}

} // namespace

TrackedCine::TrackedCine(const std::string& path, const TrackedInfo& info)
{
  const auto refuse = [&](const std::string& why) { throw Error("cannot write '" + path + "': " + why + "."); };
  const bool isNrrd = endsWith(path, ".nrrd");
  if (!isNrrd && !endsWith(path, ".mha"))
  {
    refuse("a tracked sequence goes into a file that ends in .igs.mha or .igs.nrrd; give it such a name");
  }
  if (info.poses.empty() || info.width < 1 || info.height < 1)
  {
    refuse("there are no pictures; simulate one first");
  }
  if (info.timesS.size() != info.poses.size())
  {
    refuse("there are " + std::to_string(info.poses.size()) + " poses for " + std::to_string(info.timesS.size()) +
           " pictures; give as many");
  }
  frames_ = std::make_unique<GreyFrames>(path, isNrrd ? nrrdHeader(info) : metaHeader(info), info.width, info.height,
                                         info.poses.size());
}

TrackedCine::~TrackedCine() = default;

void TrackedCine::add(const std::uint8_t* grey, int width, int height)
{
  frames_->add(grey, width, height);
}

void TrackedCine::finish()
{
  frames_->finish();
}

} // namespace sono
