#include "Files/ReadTracked.h"

#include "Core/Error.h"
#include "Labels/CsvFile.h"

#include <glm/gtc/matrix_inverse.hpp>

#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>

namespace sono {

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why)
{
  throw Error("cannot read '" + path + "': " + why + ".");
}

std::string trimmed(const std::string& text)
{
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// From one system of coordinates to another.
struct Systems
{
  std::string from;
  std::string to;
};

/// Of a name as ProbeToReference.
std::optional<Systems> systemsOf(const std::string& name)
{
  for (std::size_t at = name.find("To", 1); at != std::string::npos; at = name.find("To", at + 1))
  {
    if (at + 2 < name.size() && name[at + 2] >= 'A' && name[at + 2] <= 'Z')
    {
      return Systems{ name.substr(0, at), name.substr(at + 2) };
    }
  }
  return {};
}

struct Edge
{
  Systems systems;
  Mat4d matrix;
};

/// What a header says of a frame.
struct Frame
{
  double timeS = 0.0;
  std::map<std::string, Mat4d> transforms;
  std::set<std::string> invalid;
};

Mat4d matrixOf(const std::string& path, const std::string& key, const std::string& value)
{
  Mat4d matrix;
  std::istringstream words(value);
  int count = 0;
  for (std::string word; words >> word; ++count)
  {
    const auto number = parseNumber(word);
    if (!number)
    {
      refuse(path, "its header has '" + word + "' for a number of " + key + "; correct it");
    }
    if (count < 16)
    {
      matrix[count % 4][count / 4] = *number;
    }
  }
  if (count != 16)
  {
    refuse(path, "its header has " + std::to_string(count) + " numbers for " + key + " where 16 belong; correct it");
  }
  return matrix;
}

bool cutEnd(const std::string& end, std::string& text)
{
  if (text.size() <= end.size() || text.compare(text.size() - end.size(), end.size(), end) != 0)
  {
    return false;
  }
  text.resize(text.size() - end.size());
  return true;
}

/// Takes an entry as Seq_Frame0012_Timestamp; others are none of frames.
void take(const std::string& path, const std::string& key, const std::string& value, std::map<int, Frame>& frames)
{
  const std::string begin = "Seq_Frame";
  const std::size_t digits = begin.size();
  const std::size_t end = key.find_first_not_of("0123456789", digits);
  if (key.compare(0, begin.size(), begin) != 0 || end == std::string::npos || end == digits || end - digits > 8 ||
      key[end] != '_')
  {
    return;
  }
  Frame& frame = frames[std::stoi(key.substr(digits, end - digits))];
  std::string name = key.substr(end + 1);
  if (name == "Timestamp")
  {
    const auto number = parseNumber(value);
    if (!number)
    {
      refuse(path, "its header has '" + value + "' for " + key + "; correct it");
    }
    frame.timeS = *number;
  }
  else if (cutEnd("TransformStatus", name))
  {
    if (value != "OK")
    {
      frame.invalid.insert(name);
    }
  }
  else if (cutEnd("Transform", name))
  {
    frame.transforms[name] = matrixOf(path, key, value);
  }
}

std::map<int, Frame> framesOf(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
  {
    refuse(path, "it is not there, or protected");
  }
  constexpr std::size_t longestLine = 1 << 16;
  std::map<int, Frame> frames;
  std::string line;
  std::getline(stream, line);
  const bool isNrrd = line.compare(0, 4, "NRRD") == 0;
  const std::string between = isNrrd ? ":=" : "=";
  do
  {
    line = trimmed(line);
    const std::size_t at = line.find(between);
    if (line.size() > longestLine || (isNrrd ? line.empty() : at == std::string::npos))
    {
      break;
    }
    if (at != std::string::npos)
    {
      const std::string key = trimmed(line.substr(0, at));
      if (!isNrrd && key == "ElementDataFile")
      {
        break;
      }
      take(path, key, trimmed(line.substr(at + between.size())), frames);
    }
  }
  while (std::getline(stream, line));
  if (frames.empty())
  {
    refuse(path, "it is no tracked sequence: its header has no entries as Seq_Frame0000_ProbeToTrackerTransform; "
                 "choose a file of PLUS, .igs.mha or .igs.nrrd");
  }
  return frames;
}

/// From one system to the other by the transforms of a frame and their inverses, by the fewest; none where there is no
/// way.
std::optional<Mat4d> wayOf(const Frame& frame, const Systems& wanted)
{
  std::vector<Edge> edges;
  for (const auto& [name, matrix] : frame.transforms)
  {
    const auto systems = systemsOf(name);
    if (systems && frame.invalid.count(name) == 0)
    {
      edges.push_back({ *systems, matrix });
      edges.push_back({ { systems->to, systems->from }, glm::affineInverse(matrix) });
    }
  }
  std::map<std::string, Mat4d> reached{ { wanted.from, Mat4d(1.0) } };
  for (std::vector<std::string> border{ wanted.from }; !border.empty() && reached.count(wanted.to) == 0;)
  {
    std::vector<std::string> next;
    for (const std::string& system : border)
    {
      for (const Edge& edge : edges)
      {
        if (edge.systems.from == system && reached.emplace(edge.systems.to, edge.matrix * reached[system]).second)
        {
          next.push_back(edge.systems.to);
        }
      }
    }
    border = next;
  }
  const auto found = reached.find(wanted.to);
  return found == reached.end() ? std::nullopt : std::optional<Mat4d>(found->second);
}

[[noreturn]] void refuseTransform(const std::string& path, const std::string& transform,
                                  const std::map<int, Frame>& frames)
{
  std::set<std::string> names;
  bool isInvalid = false;
  for (const auto& [number, frame] : frames)
  {
    isInvalid = isInvalid || !frame.invalid.empty();
    for (const auto& entry : frame.transforms)
    {
      names.insert(entry.first);
    }
  }
  std::string list;
  for (const std::string& name : names)
  {
    list += (list.empty() ? "" : ", ") + name;
  }
  refuse(path, "no frame gives " + transform + (isInvalid ? ", or the tracker saw nothing in any" : "") + "; it has " +
                 (list.empty() ? "no transforms" : list));
}

} // namespace

TrackedPoses readTracked(const std::string& path, const std::string& transform, const Mat4d& probeFromOurs,
                         const Mat4d& worldFromReference)
{
  const auto wanted = systemsOf(transform);
  if (!wanted)
  {
    throw Error("Transform is '" + transform + "': it must be a name as ProbeToReference.");
  }
  const std::map<int, Frame> frames = framesOf(path);
  TrackedPoses result;
  for (const auto& [number, frame] : frames)
  {
    const auto way = wayOf(frame, *wanted);
    if (!way)
    {
      ++result.invalidCount;
      continue;
    }
    const Mat4d pose = worldFromReference * *way * probeFromOurs;
    result.poses.push_back(ProbePose{ Vec3d(pose[3]), Vec3d(pose[1]), Vec3d(pose[0]) }.orthonormalized());
    result.timesS.push_back(frame.timeS);
    result.frames.push_back(number);
  }
  if (result.poses.empty())
  {
    refuseTransform(path, transform, frames);
  }
  return result;
}

} // namespace sono
