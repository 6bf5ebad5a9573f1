#include "pqSonoPath.h"

#include "pqSonoProbeWidget.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqFileDialog.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"

#include <QGridLayout>
#include <QPushButton>

#include <algorithm>
#include <cstring>
#include <utility>

namespace {

constexpr int stepMs = 30;
constexpr double leastApartS = 0.02;
constexpr double standsS = 0.1; // so long without a movement: the probe stood still

bool isPath(const pqPipelineSource* source)
{
  return source && std::strcmp(source->getProxy()->GetXMLName(), "SonoProbePath") == 0;
}

} // namespace

pqSonoPath::pqSonoPath(std::function<pqSonoProbeWidget*()> find, QWidget* parent)
  : QWidget(parent)
  , find_(std::move(find))
{
  this->setObjectName("SonoPath");
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  record_ = addButton(grid, "Record", tr("Record Path"),
                      tr("Records where the probe is moved from now on, with the time, until it is clicked again: a "
                         "Probe Path in the pipeline, one step of undo."));
  play_ = addButton(grid, "Play", tr("Play Path"),
                    tr("Moves the probe along the Probe Path that is selected, or else the last one, in its own time; "
                       "again: stops. One step of undo."));
  sweep_ = addButton(grid, "Sweep", tr("Sweep"),
                     tr("An Ultrasound Sweep of that path: a picture of each pose, by this probe and these settings, "
                        "after Apply. Save Data writes it, as .igs.mha with the poses."));
  dataSet_ = addButton(grid, "DataSet", tr("Data Set..."),
                       tr("Writes a data set's file (JSON): an image of each pose of that path, by this probe, with a "
                          "mask of each structure. Open it with Sources > Ultrasound > Ultrasound Data Set."));
  record_->setCheckable(true);
  play_->setCheckable(true);
  QObject::connect(record_, &QPushButton::toggled, this, [this](bool wanted) { record(wanted); });
  QObject::connect(play_, &QPushButton::toggled, this, [this](bool wanted) { play(wanted); });
  QObject::connect(sweep_, &QPushButton::clicked, this, [this] { makeSweep(); });
  QObject::connect(dataSet_, &QPushButton::clicked, this, [this] { writeDataSet(); });
  steps_.setInterval(stepMs);
  this->connect(&steps_, SIGNAL(timeout()), SLOT(step()));
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  this->connect(model, SIGNAL(sourceAdded(pqPipelineSource*)), SLOT(showState()));
  this->connect(model, SIGNAL(sourceRemoved(pqPipelineSource*)), SLOT(showState()));
  this->showState();
}

QPushButton* pqSonoPath::addButton(QGridLayout* grid, const char* name, const QString& text, const QString& toolTip)
{
  auto* button = new QPushButton(text);
  button->setObjectName(name);
  button->setToolTip(toolTip);
  const int place = grid->count();
  grid->addWidget(button, place / 2, place % 2);
  return button;
}

void pqSonoPath::follow(pqPipelineSource* source)
{
  record_->setChecked(false);
  play_->setChecked(false);
  source_ = source;
  this->showState();
}

/// The one that is selected, or else the newest.
pqPipelineSource* pqSonoPath::lastPath() const
{
  pqPipelineSource* active = pqActiveObjects::instance().activeSource();
  if (isPath(active))
  {
    return active;
  }
  const auto sources = pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>();
  const auto last = std::find_if(sources.rbegin(), sources.rend(), isPath);
  return last == sources.rend() ? nullptr : *last;
}

void pqSonoPath::showState()
{
  record_->setEnabled(source_ && !play_->isChecked());
  for (QPushButton* button : { play_, sweep_, dataSet_ })
  {
    button->setEnabled(source_ && !record_->isChecked() && this->lastPath());
  }
}

void pqSonoPath::record(bool wanted)
{
  if (wanted && (widget_ = find_()))
  {
    poses_ = { { 0.0, widget_->place() } };
    clock_.start();
    QObject::connect(widget_, &pqSonoProbeWidget::moved, this, &pqSonoPath::take);
    Q_EMIT this->said(tr("Recording: move the probe, then click Record Path again."));
  }
  else if (widget_)
  {
    QObject::disconnect(widget_, &pqSonoProbeWidget::moved, this, &pqSonoPath::take);
    if (poses_.size() < 2)
    {
      Q_EMIT this->said(tr("The probe was not moved; nothing was recorded."));
    }
    else if (source_)
    {
      sonoMakePath(poses_, source_);
      pqActiveObjects::instance().setActiveSource(source_);
      Q_EMIT this->said(tr("Recorded %1 poses in %2 s.").arg(poses_.size()).arg(poses_.back().timeS, 0, 'f', 1));
    }
  }
  this->showState();
}

void pqSonoPath::take()
{
  const SonoTimedPose now{ 1e-3 * static_cast<double>(clock_.elapsed()), widget_->place() };
  const SonoTimedPose last = poses_.back();
  if (now.pose == last.pose)
  {
    return;
  }
  if (now.timeS - last.timeS < leastApartS && poses_.size() > 1)
  {
    poses_.back() = now;
    return;
  }
  if (now.timeS - last.timeS > standsS)
  {
    poses_.push_back({ now.timeS - leastApartS, last.pose });
  }
  poses_.push_back(now);
}

void pqSonoPath::play(bool wanted)
{
  pqPipelineSource* path = this->lastPath();
  if (wanted && path && (widget_ = find_()))
  {
    Q_EMIT this->begins();
    poses_ = sonoPathOf(path);
    clock_.start();
    widget_->hold(true);
    steps_.start();
  }
  else
  {
    steps_.stop();
    if (widget_)
    {
      widget_->hold(false);
    }
  }
  this->showState();
}

void pqSonoPath::end()
{
  play_->setChecked(false);
}

void pqSonoPath::step()
{
  if (!widget_ || poses_.empty())
  {
    play_->setChecked(false);
    return;
  }
  const double timeS = 1e-3 * static_cast<double>(clock_.elapsed());
  SonoWindow at;
  at.pose = sonoPoseAt(poses_, timeS);
  widget_->goTo(at);
  if (timeS > poses_.back().timeS)
  {
    play_->setChecked(false);
  }
}

void pqSonoPath::makeSweep()
{
  if (pqPipelineSource* sweep = sonoMakeSweep(this->lastPath(), source_))
  {
    pqActiveObjects::instance().setActiveSource(sweep);
  }
}

void pqSonoPath::writeDataSet()
{
  pqFileDialog dialog(nullptr, pqCoreUtilities::mainWidget(), tr("Write a data set's file"), QString(),
                      tr("Data set (*.json)"));
  dialog.setObjectName("SonoPathDataSetDialog");
  dialog.setFileMode(pqFileDialog::AnyFile);
  if (dialog.exec() != QDialog::Accepted || dialog.getSelectedFiles().isEmpty())
  {
    return;
  }
  const QString file = dialog.getSelectedFiles()[0];
  const QString refusal = sonoWriteDataSet(this->lastPath(), source_, file);
  Q_EMIT this->said(refusal.isEmpty() ? tr("Written as %1.").arg(file) : refusal);
}
