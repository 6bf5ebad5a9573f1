#include "pqSonoCaliperFollow.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqPipelineSource.h"
#include "pqPropertiesPanel.h"
#include "pqServerManagerModel.h"
#include "vtkSMProxy.h"

#include <algorithm>
#include <cstring>

namespace {

/// Whether the active source is a caliper, and all that waits for Apply.
bool isCaliperAlone()
{
  const pqPipelineSource* active = pqActiveObjects::instance().activeSource();
  if (!active || std::strcmp(active->getProxy()->GetXMLName(), "SonoCaliper") != 0)
  {
    return false;
  }
  const auto sources = pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>();
  return std::all_of(sources.begin(), sources.end(), [active](const pqPipelineSource* source) {
    return source == active || source->modifiedState() == pqProxy::UNMODIFIED;
  });
}

} // namespace

pqSonoCaliperFollow::pqSonoCaliperFollow(QObject* parent)
  : QObject(parent)
{
  soon_.setSingleShot(true);
  QObject::connect(&soon_, &QTimer::timeout, this, [this] { follow(); });
  // The panel is made after the toolbars.
  QTimer::singleShot(0, this, [this] {
    if (auto* panel = pqCoreUtilities::mainWidget()->findChild<pqPropertiesPanel*>())
    {
      QObject::connect(panel, &pqPropertiesPanel::modified, &soon_, QOverload<>::of(&QTimer::start));
    }
  });
}

void pqSonoCaliperFollow::follow()
{
  auto* panel = pqCoreUtilities::mainWidget()->findChild<pqPropertiesPanel*>();
  if (isCaliperAlone() && panel->canApply())
  {
    panel->apply();
  }
}
