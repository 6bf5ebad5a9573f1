#include "pqSonoCine.h"

#include "SonoAnatomyTime.h"
#include "SonoMovingViews.h"

#include "pqCoreUtilities.h"
#include "pqPipelineSource.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSession.h"

#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QSlider>

#include <algorithm>

namespace {

constexpr std::size_t keptPictures = 200; // 10 to 20 s of a drag
constexpr qint64 rateOverMs = 2000;
constexpr qint64 pauseMs = 500; // so long without a picture: another drag
constexpr int quickestMs = 30;
constexpr int settledMs = 500;

SonoWindow poseOf(vtkSMProxy* ultrasound)
{
  SonoWindow at;
  at.pose = sonoPoseOf(ultrasound);
  at.depthMm = vtkSMPropertyHelper(ultrasound, "DepthMm").GetAsDouble();
  return at;
}

} // namespace

pqSonoCine::pqSonoCine(QWidget* parent)
  : QWidget(parent)
  , play_(new QPushButton(tr("Play")))
  , scrubber_(new QSlider(Qt::Horizontal))
  , place_(new QLabel)
  , rate_(new QLabel)
{
  this->setObjectName("SonoCine");
  scrubber_->setObjectName("Scrubber");
  scrubber_->setAccessibleName(tr("Cine"));
  scrubber_->setToolTip(
    tr(
      "Cine loop: the last %1 pictures of a moving probe or a beating heart, newest on the right. Freeze, then drag it "
      "or use the arrow keys; the probe goes back with the picture, one step of undo.")
      .arg(keptPictures));
  play_->setObjectName("CinePlay");
  play_->setCheckable(true);
  play_->setToolTip(tr(
    "Plays the cine loop again and again, at the mean rate at which its pictures came. Freeze first; again: stops at "
    "the picture that is shown."));
  place_->setObjectName("CinePlace");
  rate_->setObjectName("Rate");
  rate_->setToolTip(
    tr("Pictures a second that were computed and drawn while the probe moved, over the last 2 s of it."));
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->addWidget(new QLabel(tr("Cine")), 0, 0);
  grid->addWidget(scrubber_, 0, 1);
  grid->addWidget(place_, 0, 2);
  grid->addWidget(play_, 0, 3);
  grid->addWidget(new QLabel(tr("Rate")), 1, 0);
  grid->addWidget(rate_, 1, 1, 1, 3);
  grid->setColumnStretch(1, 1);
  clock_.start();
  QObject::connect(scrubber_, &QSlider::valueChanged, this, [this](int place) { goTo(place); });
  QObject::connect(play_, &QPushButton::toggled, this, [this](bool wanted) { play(wanted); });
  QObject::connect(&steps_, &QTimer::timeout, this, [this] {
    if (source_ && !awaits_ && !source_->getProxy()->GetSession()->GetPendingProgress())
    {
      awaits_ = true;
      scrubber_->setValue((scrubber_->value() + 1) % static_cast<int>(pictures_.size()));
    }
  });
  settled_.setSingleShot(true);
  settled_.setInterval(settledMs);
  QObject::connect(&settled_, &QTimer::timeout, this,
                   [this] { steps_.isActive() ? settled_.start() : sonoKeepTime(source_); });
  this->showState();
}

void pqSonoCine::follow(pqPipelineSource* source)
{
  if (source_)
  {
    source_->getProxy()->RemoveObserver(shown_);
  }
  this->end();
  if (settled_.isActive())
  {
    settled_.stop();
    sonoKeepTime(source_);
  }
  source_ = source;
  pictures_.clear();
  times_.clear();
  if (source_)
  {
    shown_ = pqCoreUtilities::connect(source_->getProxy(), SonoMovingViews::PictureShownEvent, this, SLOT(look()));
  }
  this->showState();
}

void pqSonoCine::setFrozen(bool frozen)
{
  frozen_ = frozen;
  if (!frozen_)
  {
    this->end();
  }
  this->showState();
}

void pqSonoCine::end()
{
  play_->setChecked(false);
}

void pqSonoCine::goTo(int place)
{
  this->showState();
  if (!frozen_ || static_cast<std::size_t>(place) >= pictures_.size())
  {
    return;
  }
  const Picture& wanted = pictures_[static_cast<std::size_t>(place)];
  const bool isOtherMoment = wanted.moment != sonoTimeOf(source_);
  if (isOtherMoment)
  {
    sonoSetTime(source_, wanted.moment);
    settled_.start();
  }
  Q_EMIT this->scrubbed(wanted.at, isOtherMoment);
}

void pqSonoCine::play(bool wanted)
{
  awaits_ = false;
  wanted ? steps_.start(this->meanIntervalMs()) : steps_.stop();
  Q_EMIT this->played(wanted);
}

/// Between two pictures, without what lies between drags.
int pqSonoCine::meanIntervalMs() const
{
  qint64 sum = 0;
  qint64 count = 0;
  for (std::size_t i = 1; i < pictures_.size(); ++i)
  {
    const qint64 apart = pictures_[i].shownMs - pictures_[i - 1].shownMs;
    sum += apart < pauseMs ? apart : 0;
    count += apart < pauseMs ? 1 : 0;
  }
  return count > 0 ? std::max(static_cast<int>(sum / count), quickestMs) : static_cast<int>(pauseMs);
}

void pqSonoCine::look()
{
  awaits_ = false;
  if (!source_ || frozen_ || vtkSMPropertyHelper(source_->getProxy(), "Preview").GetAsInt() != 1)
  {
    return;
  }
  const qint64 now = clock_.elapsed();
  const Picture shown{ poseOf(source_->getProxy()), sonoTimeOf(source_), now };
  if (!pictures_.empty() && pictures_.back().at.pose == shown.at.pose &&
      pictures_.back().at.depthMm == shown.at.depthMm && pictures_.back().moment == shown.moment)
  {
    return;
  }
  pictures_.push_back(shown);
  if (pictures_.size() > keptPictures)
  {
    pictures_.pop_front();
  }
  if (!times_.empty() && now - times_.back() > pauseMs)
  {
    times_.clear();
  }
  times_.push_back(now);
  while (now - times_.front() > rateOverMs)
  {
    times_.pop_front();
  }
  this->showState();
}

void pqSonoCine::showState()
{
  const int count = static_cast<int>(pictures_.size());
  if (!frozen_ || scrubber_->maximum() != std::max(count - 1, 0))
  {
    const QSignalBlocker quiet(scrubber_);
    scrubber_->setRange(0, std::max(count - 1, 0));
    scrubber_->setValue(count - 1);
  }
  scrubber_->setEnabled(frozen_ && count > 1);
  play_->setEnabled(scrubber_->isEnabled());
  place_->setText(count > 0 ? tr("%1 of %2").arg(scrubber_->value() + 1).arg(count) : tr("-"));
  const qint64 spanMs = times_.size() > 1 ? times_.back() - times_.front() : 0;
  if (spanMs > 0)
  {
    const double rate = 1000.0 * static_cast<double>(times_.size() - 1) / static_cast<double>(spanMs);
    rate_->setText(tr("%1 pictures/s").arg(rate, 0, 'f', 1));
  }
  else if (count == 0)
  {
    rate_->setText(tr("shown while the probe moves"));
  }
}
