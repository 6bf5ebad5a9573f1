#include "DataSets/BodyViews.h"

#include "Probe/AcousticWindow.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <string>

namespace sono {

namespace {

/// The standard view of a name.
BodyView standardView(const std::vector<StandardView>& views, const std::string& name)
{
  std::string names;
  for (const StandardView& view : views)
  {
    if (view.name == name)
    {
      return { view.refusal.empty() ? std::optional<ProbePose>(view.pose) : std::nullopt, view };
    }
    names += (names.empty() ? "" : ", ") + view.name;
  }
  throw Error("'" + name + "' is no standard view; choose one of " + names + ", or give it a 'pose' or a 'window'.");
}

} // namespace

std::vector<BodyView> findBodyViews(const Scene& scene, const DataSetPatient& patient, const ThoraxParameters& thorax,
                                    const ProbeSettings& probe, const GridPlacement& grid,
                                    const BodyAugmentation& augmentation, const Progress& progress)
{
  std::vector<BodyView> views;
  std::vector<StandardView> standard;
  for (const DataSetView& view : patient.views)
  {
    const bool isBundled = patient.labels.empty() && !patient.isDrawn && view.name == "A4C";
    if (!view.window.empty())
    {
      views.push_back({ findAcousticWindows(scene, windowTarget(scene, view.window), probe, 1).front().pose, {} });
    }
    else if (view.pose || isBundled)
    {
      views.push_back({ augmented(view.pose ? *view.pose : thoraxPhantomA4C(thorax), grid, augmentation), {} });
    }
    else
    {
      if (standard.empty())
      {
        std::set<std::string> names;
        std::transform(patient.views.begin(), patient.views.end(), std::inserter(names, names.end()),
                       [](const DataSetView& wanted) { return wanted.name; });
        standard = findStandardViews(
          scene, [&](const std::string&) { return probe; }, progress, names);
      }
      views.push_back(standardView(standard, view.name));
      if (views.back().pose && augmentation.isMirrored)
      {
        views.back().pose->lateral = -views.back().pose->lateral; // as `augmented` turns a given one
      }
    }
  }
  if (std::none_of(views.begin(), views.end(), [](const BodyView& view) { return view.pose.has_value(); }))
  {
    throw Error("none of its views is obtainable; give it others. " + views.back().found->refusal);
  }
  return views;
}

} // namespace sono
