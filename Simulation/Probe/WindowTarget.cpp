#include "Probe/WindowTarget.h"

#include "Core/Error.h"
#include "Core/ParallelFor.h"
#include "Labels/LabelCode.h"
#include "Labels/LabelWords.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <mutex>
#include <numeric>
#include <set>
#include <utility>

namespace sono {
namespace {

using Words = std::set<std::string>;

/// An organ that is asked for by a name of its own: labels with all words of one of the alternatives, which are
/// separated by '|', and none of `without`.
struct Organ
{
  const char* name;
  const char* alternatives;
  const char* without;
  const char* preset;
};

const char* const phased = "phased_p4-2";
const char* const curved = "curvilinear_c5-2";
const char* const linear = "linear_l14";

const Organ organs[] = {
  { "heart",
    "heart|myocardium|ventricle|atrium|ventricular|atrial|interventricular|interatrial|papillary|mitral|tricuspid",
    "brain lateral third fourth vein artery", phased },
  { "liver", "liver", "vessel tumor lesion", curved },
  { "kidney", "kidney", "cyst tumor lesion", curved },
  { "spleen", "spleen", "", curved },
  { "gallbladder", "gallbladder", "", curved },
  { "pancreas", "pancreas", "tumor lesion", curved },
  { "stomach", "stomach", "", curved },
  { "bladder", "bladder", "", curved },
  { "prostate", "prostate", "", curved },
  { "uterus", "uterus", "", curved },
  { "aorta", "aorta", "", curved },
  { "inferior vena cava", "inferior vena cava|ivc|postcava", "", curved },
  { "portal vein", "portal vein", "", curved },
  { "thyroid", "thyroid", "cartilage", linear },
  { "carotid", "carotid", "", linear },
  { "jugular vein", "jugular", "", linear },
};

const Organ* const heartOrgan = &organs[0];
const Organ* const liverOrgan = &organs[1];
const Organ* const kidneyOrgan = &organs[2];

/// As LabelWords.h has them; r and l are sides, and the gall bladder is no bladder.
Words wordsOf(const std::string& name)
{
  Words words;
  for (const std::string& word : wordsOfName(name))
  {
    words.insert(word == "r" ? "right" : word == "l" ? "left" : word);
  }
  if (words.count("gall") && words.erase("bladder"))
  {
    words.erase("gall");
    words.insert("gallbladder");
  }
  return words;
}

bool hasAll(const Words& words, const Words& wanted)
{
  return std::includes(words.begin(), words.end(), wanted.begin(), wanted.end());
}

bool isOf(const Organ& organ, const Words& label)
{
  for (const std::string& word : wordsOf(organ.without))
  {
    if (label.count(word))
    {
      return false;
    }
  }
  const std::string all = organ.alternatives;
  for (std::size_t from = 0; from < all.size();)
  {
    const std::size_t end = std::min(all.find('|', from), all.size());
    if (hasAll(label, wordsOf(all.substr(from, end - from))))
    {
      return true;
    }
    from = end + 1;
  }
  return false;
}

bool isOutside(const Scene& scene, const LabelInfo& label)
{
  return scene.tissueOfLabel()[std::size_t(label.id)] == scene.outsideIndex();
}

template<class Wanted>
std::vector<int> labelsThat(const Scene& scene, const Wanted& wanted)
{
  std::vector<int> ids;
  for (const LabelInfo& label : scene.volume().labels)
  {
    if (!isOutside(scene, label) && wanted(label))
    {
      ids.push_back(label.id);
    }
  }
  return ids;
}

/// An organ of one side, or of both where none is named.
std::vector<int> namedLabelsOf(const Scene& scene, const Organ& organ, const Words& sides)
{
  return labelsThat(scene, [&](const LabelInfo& label) {
    const Words words = wordsOf(label.name);
    return isOf(organ, words) && hasAll(words, sides);
  });
}

/// The same, of a heart or a liver that no name tells by the tissues: of a heart with the chambers that guessHeart
/// finds.
std::vector<int> labelsOf(const Scene& scene, const Organ& organ, const Words& sides)
{
  std::vector<int> labels = namedLabelsOf(scene, organ, sides);
  const char* tissue = &organ == heartOrgan ? "myocardium" : &organ == liverOrgan ? "liver" : nullptr;
  if (!labels.empty() || !sides.empty() || !tissue)
  {
    return labels;
  }
  labels = labelsThat(scene, [&](const LabelInfo& label) { return label.tissue == tissue; });
  if (&organ == heartOrgan && !labels.empty())
  {
    return labelsThat(scene, [&](const LabelInfo& label) {
      return label.tissue == tissue || (label.tissue == "blood" && saysNothing(label.name));
    });
  }
  return labels;
}

WindowTarget targetOf(const std::string& name, std::vector<int> labels, const std::string& preset)
{
  return { name, std::move(labels), {}, preset, preset == linear ? curved : "" };
}

std::string presetOf(const Scene& scene, const std::vector<int>& labels)
{
  for (const Organ& organ : organs)
  {
    if (isOf(organ, wordsOf(scene.volume().find(labels.front())->name)))
    {
      return organ.preset;
    }
  }
  return curved;
}

/// How much of an organ the box holds.
struct OrganInBox
{
  std::int64_t voxels; ///< half of them: every other voxel of a row is looked at
  bool isCut;          ///< its section with one of the box's faces is more than half of its largest one along that axis
};

OrganInBox organInBox(const Scene& scene, const std::vector<int>& labels)
{
  std::vector<char> wanted(65536, 0);
  for (const int id : labels)
  {
    wanted[std::size_t(id)] = 1;
  }
  const Vec3i n = scene.placement().size;
  std::array<std::vector<int>, 3> sections; // voxels by slice
  for (int axis = 0; axis < 3; ++axis)
  {
    sections[std::size_t(axis)].assign(std::size_t(n[axis]), 0);
  }
  std::mutex mutex;
  parallelFor(n.z, {}, [&](int k) {
    std::array<std::vector<int>, 2> own{ std::vector<int>(std::size_t(n.x)), std::vector<int>(std::size_t(n.y)) };
    for (int j = 0; j < n.y; ++j)
    {
      const std::uint16_t* row =
        scene.volume().voxels.data() + std::size_t(n.x) * (std::size_t(j) + std::size_t(n.y) * k);
      for (int i = (j + k) % 2; i < n.x; i += 2)
      {
        const int is = wanted[row[i]];
        own[0][std::size_t(i)] += is;
        own[1][std::size_t(j)] += is;
      }
    }
    sections[2][std::size_t(k)] = std::accumulate(own[1].begin(), own[1].end(), 0);
    const std::lock_guard<std::mutex> lock(mutex); // whole numbers: in whatever order
    for (std::size_t axis : { 0, 1 })
    {
      std::transform(own[axis].begin(), own[axis].end(), sections[axis].begin(), sections[axis].begin(), std::plus<>());
    }
  });
  const bool isCut = std::any_of(sections.begin(), sections.end(), [](const std::vector<int>& section) {
    return 2 * std::max(section.front(), section.back()) > *std::max_element(section.begin(), section.end());
  });
  return { std::accumulate(sections[0].begin(), sections[0].end(), std::int64_t(0)), isCut };
}

/// Whether the liver is the better first picture of the two: where the heart goes on beyond the box and the liver does
/// not, or where next to nothing of the heart is in it.
bool showsLiverRather(const OrganInBox& heart, const OrganInBox& liver)
{
  return heart.isCut && (!liver.isCut || 10 * heart.voxels < liver.voxels);
}

/// A kidney where there is more of it than of a liver that is cut.
WindowTarget liverOrKidney(const Scene& scene, const std::vector<int>& liver, const OrganInBox& ofLiver)
{
  const WindowTarget whole = targetOf(liverOrgan->name, liver, liverOrgan->preset);
  for (const char* side : { "right", "left" })
  {
    const std::vector<int> kidney = ofLiver.isCut ? labelsOf(scene, *kidneyOrgan, { side }) : std::vector<int>();
    if (!kidney.empty() && organInBox(scene, kidney).voxels > ofLiver.voxels)
    {
      return targetOf(side + std::string(" ") + kidneyOrgan->name, kidney, kidneyOrgan->preset);
    }
  }
  return whole;
}

/// The heart, or the liver where there is no heart or the liver is the better picture, or a kidney instead of the tip
/// of a liver, or else the body.
WindowTarget defaultTarget(const Scene& scene)
{
  const std::vector<int> heart = labelsOf(scene, *heartOrgan, {});
  const std::vector<int> liver = labelsOf(scene, *liverOrgan, {});
  if (!liver.empty())
  {
    const OrganInBox ofHeart = heart.empty() ? OrganInBox{ 0, true } : organInBox(scene, heart);
    const OrganInBox ofLiver = ofHeart.isCut ? organInBox(scene, liver) : OrganInBox{ 0, true };
    if (showsLiverRather(ofHeart, ofLiver))
    {
      return liverOrKidney(scene, liver, ofLiver);
    }
  }
  if (!heart.empty())
  {
    return targetOf(heartOrgan->name, heart, heartOrgan->preset);
  }
  const auto all = labelsThat(scene, [](const LabelInfo&) { return true; });
  if (all.empty())
  {
    throw Error("The label map holds nothing but what is outside the body; choose one with labelled anatomy.");
  }
  return targetOf("body", all, "");
}

} // namespace

WindowTarget windowTarget(const Scene& scene, const std::string& name)
{
  const Words words = wordsOf(name);
  if (words.empty())
  {
    return defaultTarget(scene);
  }
  Words sides;
  Words rest;
  for (const std::string& word : words)
  {
    (word == "left" || word == "right" ? sides : rest).insert(word);
  }
  for (const Organ& organ : organs)
  {
    if (wordsOf(organ.name) == rest)
    {
      const std::vector<int> labels = labelsOf(scene, organ, sides);
      if (!labels.empty())
      {
        return targetOf(name, labels, organ.preset);
      }
    }
  }
  const auto labels = labelsThat(scene, [&](const LabelInfo& label) { return hasAll(wordsOf(label.name), words); });
  if (labels.empty())
  {
    constexpr std::size_t most = 40;
    const std::vector<std::string> names = windowTargetNames(scene);
    std::string list;
    for (std::size_t i = 0; i < std::min(most, names.size()); ++i)
    {
      list += (i == 0 ? "" : ", ") + names[i];
    }
    throw Error("The label map has no '" + name + "'; it has: " + list +
                (names.size() > most ? " and " + std::to_string(names.size() - most) + " more." : "."));
  }
  return targetOf(name, labels, presetOf(scene, labels));
}

WindowTarget windowTarget(const Vec3d& pointMm)
{
  return { "target", {}, pointMm, "", "" };
}

std::vector<std::string> windowTargetNames(const Scene& scene)
{
  std::vector<std::string> names;
  for (const Organ& organ : organs)
  {
    if (labelsOf(scene, organ, {}).empty())
    {
      continue;
    }
    names.emplace_back(organ.name);
    // The heart's labels have sides, too, but of its chambers.
    const bool hasSides = organ.preset != phased && !labelsOf(scene, organ, { "right" }).empty() &&
                          !labelsOf(scene, organ, { "left" }).empty();
    for (const char* side : { "right", "left" })
    {
      if (hasSides)
      {
        names.push_back(side + std::string(" ") + organ.name);
      }
    }
  }
  for (const LabelInfo& label : scene.volume().labels)
  {
    if (!isOutside(scene, label) && std::find(names.begin(), names.end(), label.name) == names.end())
    {
      names.push_back(label.name);
    }
  }
  return names;
}

} // namespace sono
