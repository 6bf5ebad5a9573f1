#include "pqSonoBeat.h"

#include "SonoAnatomyTime.h"
#include "SonoPhases.h"
#include "pqSonoProbeWidget.h"

#include "pqCoreUtilities.h"
#include "pqPipelineSource.h"
#include "pqTimeKeeper.h"
#include "pqUndoStack.h"
#include "vtkCommand.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSession.h"
#include "vtkSMTrace.h"
#include "vtkSonoPhasesAhead.h"

#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>

#include <cmath>
#include <utility>

namespace {

constexpr const char* heartRate = "HeartRate";
constexpr int lookForPhaseMs = 15;
constexpr int fewPhases = 2; // that a beat can be seen in
constexpr double usualPerMin = 60.0;
// Times of a heart that are in seconds; those of files are mere numbers.
constexpr double shortestCycleS = 0.3;
constexpr double longestCycleS = 2.0;

/// How many beats a minute equidistant phases of one cycle make.
double rateOf(const QList<double>& times)
{
  const double cycleS = (times.last() - times.first()) * times.size() / (times.size() - 1);
  return cycleS >= shortestCycleS && cycleS <= longestCycleS ? 60.0 / cycleS : usualPerMin;
}

} // namespace

pqSonoBeat::pqSonoBeat(std::function<pqSonoProbeWidget*()> find, QWidget* parent)
  : QWidget(parent)
  , find_(std::move(find))
  , play_(new QPushButton(tr("Beat")))
  , rate_(new QDoubleSpinBox)
{
  this->setObjectName("SonoBeat");
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  play_->setObjectName("Beat");
  play_->setCheckable(true);
  play_->setToolTip(
    tr("Plays the phases of the label map at the heart's rate, again and again, in pictures as of a moving "
       "probe; it may be dragged meanwhile. At first the anatomy of each phase is made in the background, and "
       "those that are ready are played. Again: stops at the phase that is shown, in full."));
  rate_->setObjectName("HeartRate");
  rate_->setAccessibleName(tr("Heart rate"));
  rate_->setKeyboardTracking(false); // a number is one step of undo, not a digit
  rate_->setRange(20.0, 300.0);
  rate_->setDecimals(0);
  rate_->setValue(usualPerMin);
  rate_->setSuffix(tr(" / min"));
  rate_->setToolTip(
    tr("Heart rate in beats a minute, 20 to 300: all phases together are one beat. At first what the times "
       "of the phases say, or 60 where they are no seconds, as those of files."));
  row->addWidget(play_);
  row->addWidget(new QLabel(tr("Rate")));
  row->addWidget(rate_);
  QObject::connect(rate_, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, [this](double rate) {
    SCOPED_UNDO_SET(tr("Heart Rate"));
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", source_->getProxy());
    vtkSMPropertyHelper(source_->getProxy(), heartRate).Set(rate);
    source_->getProxy()->UpdateVTKObjects();
  });
  QObject::connect(play_, &QPushButton::toggled, this, [this](bool wanted) { play(wanted); });
  steps_.setInterval(lookForPhaseMs);
  this->connect(&steps_, SIGNAL(timeout()), SLOT(step()));
}

pqSonoBeat::~pqSonoBeat() = default;

void pqSonoBeat::follow(pqPipelineSource* source)
{
  play_->setChecked(false);
  ahead_.reset();
  if (source_)
  {
    source_->getProxy()->GetProperty(heartRate)->RemoveObserver(rateSeen_);
  }
  if (pqTimeKeeper* before = sonoTimeKeeperOf(source_))
  {
    before->disconnect(this);
  }
  source_ = source;
  if (pqTimeKeeper* now = sonoTimeKeeperOf(source_))
  {
    this->connect(now, SIGNAL(timeStepsChanged()), SLOT(showState()));
    rateSeen_ = pqCoreUtilities::connect(source_->getProxy()->GetProperty(heartRate), vtkCommand::ModifiedEvent, this,
                                         SLOT(showState()));
  }
  this->showState();
}

void pqSonoBeat::end()
{
  play_->setChecked(false);
}

QList<double> pqSonoBeat::times() const
{
  const pqTimeKeeper* keeper = sonoTimeKeeperOf(source_);
  return keeper ? keeper->getTimeSteps() : QList<double>();
}

void pqSonoBeat::showState()
{
  const QList<double> times = this->times();
  const bool isMoving = times.size() > 1;
  this->setEnabled(isMoving);
  if (isMoving)
  {
    const double given = vtkSMPropertyHelper(source_->getProxy(), heartRate).GetAsDouble();
    const QSignalBlocker quiet(rate_); // what is shown is nobody's choice
    rate_->setValue(given > 0.0 ? given : rateOf(times));
  }
}

void pqSonoBeat::play(bool wanted)
{
  if (wanted && (widget_ = find_()) && widget_->isLive())
  {
    Q_EMIT this->begins();
    phase_ = -1;
    isPlaying_ = true;
    clock_.start();
    widget_->hold(true);
    ahead_.reset();
    ahead_ = SonoPhases::begin(widget_->proxy());
    steps_.start();
    return;
  }
  if (isPlaying_)
  {
    this->stop();
  }
  else if (wanted)
  {
    Q_EMIT this->said(pqSonoProbeWidget::tickLive());
    play_->setChecked(false);
  }
}

void pqSonoBeat::stop()
{
  isPlaying_ = false;
  if (ahead_)
  {
    ahead_->work()->TakeReady();
    ahead_->work()->Stop(); // step() goes on until it has ended
    Q_EMIT this->said(QString());
  }
  if (!widget_)
  {
    return;
  }
  if (phase_ >= 0)
  {
    sonoKeepTime(source_);
  }
  widget_->hold(false);
}

/// Whether the phase of a time is still to be made.
bool pqSonoBeat::waitsFor(double time)
{
  if (!ahead_)
  {
    return false;
  }
  const int all = ahead_->work()->GetNumberOfPhases();
  const int ready = ahead_->work()->TakeReady();
  if (ready == all)
  {
    ahead_.reset();
    Q_EMIT this->said(QString());
    return false;
  }
  Q_EMIT this->said(tr("%1 of %2 phases are ready.").arg(ready).arg(all));
  if (ready < fewPhases)
  {
    clock_.start(); // the first beat begins with them
    return true;
  }
  return !ahead_->work()->IsReady(time);
}

void pqSonoBeat::step()
{
  if (!isPlaying_)
  {
    if (!ahead_ || ahead_->work()->HasEnded())
    {
      ahead_.reset();
      steps_.stop();
    }
    return;
  }
  const QList<double> times = this->times();
  if (!widget_ || !source_ || times.size() < 2)
  {
    play_->setChecked(false);
    return;
  }
  const double beats = 1e-3 * static_cast<double>(clock_.elapsed()) * rate_->value() / 60.0;
  const int phase = static_cast<int>((beats - std::floor(beats)) * times.size());
  if (phase == phase_ || widget_->proxy()->GetSession()->GetPendingProgress() || this->waitsFor(times[phase]))
  {
    return;
  }
  phase_ = phase;
  sonoSetTime(source_, times[phase]);
  widget_->showAgain();
  steps_.start(); // not until what came meanwhile has had its turn
}
