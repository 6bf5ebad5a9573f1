#include "pqSonoCine.h"

#include "SonoMovingViews.h"

#include "pqCoreUtilities.h"
#include "pqPipelineSource.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

#include <QGridLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QSlider>

#include <algorithm>

namespace {

constexpr std::size_t keptPoses = 200; // 10 to 20 s of a drag
constexpr qint64 rateOverMs = 2000;
constexpr qint64 pauseMs = 500; // so long without a picture: another drag

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
  , scrubber_(new QSlider(Qt::Horizontal))
  , place_(new QLabel)
  , rate_(new QLabel)
{
  this->setObjectName("SonoCine");
  scrubber_->setObjectName("Scrubber");
  scrubber_->setAccessibleName(tr("Cine"));
  scrubber_->setToolTip(
    tr("Cine loop: the last %1 pictures of a moving probe, newest on the right. Freeze, then drag it "
       "or use the arrow keys; the probe goes back with the picture, one step of undo.")
      .arg(keptPoses));
  place_->setObjectName("CinePlace");
  rate_->setObjectName("Rate");
  rate_->setToolTip(
    tr("Pictures a second that were computed and drawn while the probe moved, over the last 2 s of it."));
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->addWidget(new QLabel(tr("Cine")), 0, 0);
  grid->addWidget(scrubber_, 0, 1);
  grid->addWidget(place_, 0, 2);
  grid->addWidget(new QLabel(tr("Rate")), 1, 0);
  grid->addWidget(rate_, 1, 1, 1, 2);
  grid->setColumnStretch(1, 1);
  clock_.start();
  QObject::connect(scrubber_, &QSlider::valueChanged, this, [this](int at) {
    this->showState();
    if (frozen_ && static_cast<std::size_t>(at) < poses_.size())
    {
      Q_EMIT this->scrubbed(poses_[static_cast<std::size_t>(at)]);
    }
  });
  this->showState();
}

void pqSonoCine::follow(pqPipelineSource* source)
{
  if (source_)
  {
    source_->getProxy()->RemoveObserver(shown_);
  }
  source_ = source;
  poses_.clear();
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
  this->showState();
}

void pqSonoCine::look()
{
  if (!source_ || frozen_ || vtkSMPropertyHelper(source_->getProxy(), "Preview").GetAsInt() != 1)
  {
    return;
  }
  const SonoWindow at = poseOf(source_->getProxy());
  if (!poses_.empty() && poses_.back().pose == at.pose && poses_.back().depthMm == at.depthMm)
  {
    return;
  }
  poses_.push_back(at);
  if (poses_.size() > keptPoses)
  {
    poses_.pop_front();
  }
  const qint64 now = clock_.elapsed();
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
  const int count = static_cast<int>(poses_.size());
  if (!frozen_ || scrubber_->maximum() != std::max(count - 1, 0))
  {
    const QSignalBlocker quiet(scrubber_);
    scrubber_->setRange(0, std::max(count - 1, 0));
    scrubber_->setValue(count - 1);
  }
  scrubber_->setEnabled(frozen_ && count > 1);
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
