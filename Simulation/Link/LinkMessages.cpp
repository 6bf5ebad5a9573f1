#include "Link/LinkMessages.h"

#include "Core/Error.h"

#include <igtlImageMessage.h>
#include <igtlMessageHeader.h>
#include <igtlTransformMessage.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>

namespace sono {

namespace {

constexpr double rasOfLps[3] = { -1.0, -1.0, 1.0 };

/// A transform to the world, of columns.
void fill(const Vec3d& x, const Vec3d& y, const Vec3d& z, const Vec3d& origin, igtl::Matrix4x4& matrix)
{
  igtl::IdentityMatrix(matrix);
  const Vec3d* columns[4] = { &x, &y, &z, &origin };
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 4; ++column)
    {
      matrix[row][column] = float(rasOfLps[row] * (*columns[column])[row]);
    }
  }
}

std::string bytesOf(igtl::MessageBase& message)
{
  message.Pack();
  return { static_cast<const char*>(message.GetPackPointer()), std::size_t(message.GetPackSize()) };
}

std::string word(const char* bytes, std::size_t length)
{
  const char* const end = std::find(bytes, bytes + length, '\0');
  return { bytes, end };
}

} // namespace

void requireLinkLibrary() {}

std::string linkMessages(const LinkPicture& picture)
{
  const ProbePose& pose = picture.pose;
  const Vec3d across = glm::cross(pose.lateral, pose.axial);
  igtl::TimeStamp::Pointer now = igtl::TimeStamp::New();
  now->GetTime();

  igtl::ImageMessage::Pointer image = igtl::ImageMessage::New();
  image->SetDeviceName("SonoVDB");
  image->SetTimeStamp(now);
  image->SetDimensions(picture.width, picture.height, 1);
  image->SetSpacing(float(picture.pixelMm), float(picture.pixelMm), float(picture.pixelMm));
  image->SetScalarTypeToUint8();
  image->SetCoordinateSystem(igtl::ImageMessage::COORDINATE_RAS);
  // Its place is that of the image's middle.
  const double middleMm[2] = { picture.firstMm[0] + 0.5 * (picture.width - 1) * picture.pixelMm,
                               picture.firstMm[1] + 0.5 * (picture.height - 1) * picture.pixelMm };
  igtl::Matrix4x4 matrix;
  fill(pose.lateral, pose.axial, across, pose.positionMm + middleMm[0] * pose.lateral + middleMm[1] * pose.axial,
       matrix);
  image->SetMatrix(matrix);
  image->AllocateScalars();
  std::memcpy(image->GetScalarPointer(), picture.grey.data(), picture.grey.size());

  igtl::TransformMessage::Pointer probe = igtl::TransformMessage::New();
  probe->SetDeviceName("SonoProbeToReference");
  probe->SetTimeStamp(now);
  fill(pose.lateral, pose.axial, across, pose.positionMm, matrix);
  probe->SetMatrix(matrix);
  return bytesOf(*image) + bytesOf(*probe);
}

std::optional<LinkHeader> readLinkHeader(const char* bytes)
{
  const auto number = [bytes](std::size_t first, std::size_t count) {
    std::uint64_t value = 0;
    for (std::size_t n = first; n < first + count; ++n)
    {
      value = value << 8 | std::uint8_t(bytes[n]); // the highest byte comes first
    }
    return value;
  };
  LinkHeader header{ word(bytes + 2, 12), word(bytes + 14, 20), number(42, 8) };
  const bool isWord = !header.type.empty() && std::all_of(header.type.begin(), header.type.end(), [](unsigned char c) {
    return std::isupper(c) != 0 || std::isdigit(c) != 0 || c == '_';
  });
  const std::uint64_t version = number(0, 2);
  return isWord && version >= 1 && version <= 3 ? std::optional<LinkHeader>(header) : std::nullopt;
}

ProbePose readLinkPose(const std::string& message)
{
  igtl::MessageHeader::Pointer header = igtl::MessageHeader::New();
  header->InitPack();
  std::memcpy(header->GetPackPointer(), message.data(), linkHeaderBytes);
  header->Unpack();
  igtl::TransformMessage::Pointer transform = igtl::TransformMessage::New();
  transform->SetMessageHeader(header);
  transform->AllocatePack();
  const std::size_t bodyBytes = message.size() - linkHeaderBytes;
  const bool isWhole = std::size_t(transform->GetPackBodySize()) == bodyBytes;
  if (isWhole)
  {
    std::memcpy(transform->GetPackBodyPointer(), message.data() + linkHeaderBytes, bodyBytes);
  }
  if (!isWhole || (transform->Unpack(1) & igtl::MessageHeader::UNPACK_BODY) == 0)
  {
    throw Error("it is damaged");
  }
  igtl::Matrix4x4 matrix;
  transform->GetMatrix(matrix);
  Vec3d columns[4];
  for (int column = 0; column < 4; ++column)
  {
    for (int row = 0; row < 3; ++row)
    {
      columns[column][row] = rasOfLps[row] * double(matrix[row][column]);
    }
  }
  constexpr double tolerance = 0.01;
  const Mat3d turn(columns[0], columns[1], columns[2]);
  const Mat3d product = glm::transpose(turn) * turn;
  double worst = std::abs(glm::determinant(turn) - 1.0);
  for (int n = 0; n < 9; ++n)
  {
    worst = std::max(worst, std::abs(product[n / 3][n % 3] - (n % 4 == 0 ? 1.0 : 0.0)));
  }
  if (!(worst < tolerance) || !std::isfinite(columns[3].x + columns[3].y + columns[3].z))
  {
    throw Error("it mirrors, shears or scales, and a pose only turns and shifts");
  }
  return ProbePose{ columns[3], columns[1], columns[0] }.orthonormalized();
}

} // namespace sono
