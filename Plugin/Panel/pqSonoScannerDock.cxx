#include "pqSonoScannerDock.h"

#include "SonoFreeze.h"
#include "SonoScannerSettings.h"
#include "SonoSplitScreen.h"
#include "SonoStore.h"
#include "SonoUltrasoundHere.h"
#include "SonoWidgetOf.h"
#include "pqSonoBeat.h"
#include "pqSonoCine.h"
#include "pqSonoKeptAlike.h"
#include "pqSonoPath.h"
#include "pqSonoProbeWidget.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqFileDialog.h"
#include "pqPipelineSource.h"
#include "pqPropertiesPanel.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "vtkCommand.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"
#include "vtkSMUncheckedPropertyHelper.h"

#include <QAction>
#include <QDateTime>
#include <QGridLayout>
#include <QLabel>
#include <QMainWindow>
#include <QScrollArea>
#include <QScrollBar>
#include <QTimer>
#include <QToolBar>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace {

constexpr double gainStepDb = 1.0;
constexpr double depthStepMm = 10.0;

double dot(const std::vector<double>& a, const std::vector<double>& b)
{
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

std::vector<double> numbersOf(pqPipelineSource* source, const char* property)
{
  return vtkSMPropertyHelper(source->getProxy(), property).GetDoubleArray();
}

bool isVolumeProbe(pqPipelineSource* source)
{
  constexpr int matrix = 3;
  return vtkSMPropertyHelper(source->getProxy(), "ScanKind").GetAsInt() == matrix;
}

} // namespace

pqSonoScannerDock::pqSonoScannerDock(QWidget* parent)
  : QDockWidget(tr("Ultrasound Scanner"), parent)
  , message_(new QLabel)
  , scroll_(new QScrollArea)
  , controls_(new QWidget)
  , rows_(new QVBoxLayout(controls_))
  , cine_(new pqSonoCine)
  , path_(new pqSonoPath([this] { return probeWidget(); }))
  , beat_(new pqSonoBeat([this] { return probeWidget(); }))
{
  freezeAct_ = this->addAct("Freeze", tr("Freeze"), Qt::Key_F6,
                            tr("The picture stays while the probe moves and scan settings change; gain and grey still "
                               "act on it. Again: what was changed meanwhile is applied."));
  freezeAct_->setCheckable(true);
  QObject::connect(freezeAct_, &QAction::toggled, this, [this](bool frozen) { freeze(frozen); });
  QAction* storeAct = this->addAct("Store", tr("Store"), Qt::Key_F7,
                                   tr("Write the flat picture as PNG, the transducer on top, into the folder that is "
                                      "asked for at the first time."));
  QObject::connect(storeAct, &QAction::triggered, this, [this] { store(); });
  QAction* folderAct = new QAction(tr("Store in..."), this);
  folderAct->setIconText("...");
  folderAct->setToolTip(tr("Choose another folder for stored pictures."));
  QObject::connect(folderAct, &QAction::triggered, this, [this] {
    SCOPED_UNDO_SET(tr("Store Folder"));
    chooseFolder();
  });
  QAction* flipAct = this->addAct("Flip", tr("Flip"), Qt::Key_F8,
                                  tr("Left to right: turns the probe by 180 degrees about its axis, and its marker "
                                     "with it."));
  QObject::connect(flipAct, &QAction::triggered, this, [this] {
    if (pqSonoProbeWidget* widget = probeWidget())
    {
      widget->turn(180.0);
    }
  });
  planeAct_ = this->addAct("Plane", tr("Plane"), Qt::Key_F9,
                           tr("Of a matrix probe: turns it by 90 degrees to the second of its two planes; again: "
                              "back."));
  planeAct_->setCheckable(true);
  QObject::connect(planeAct_, &QAction::triggered, this, [this] { turnPlane(); });
  biplaneAct_ = this->addAct("Biplane", tr("Biplane"), Qt::SHIFT + Qt::Key_F9,
                             tr("Of a matrix probe: the pictures of two of its planes side by side, the second at 90 "
                                "degrees to the first; again: the volume."));
  biplaneAct_->setCheckable(true);
  QObject::connect(biplaneAct_, &QAction::triggered, this, [this] { toggleBiplane(); });
  this->addNudge("GainUp", tr("More Gain"), Qt::ALT + Qt::Key_PageUp, "GainDb", gainStepDb);
  this->addNudge("GainDown", tr("Less Gain"), Qt::ALT + Qt::Key_PageDown, "GainDb", -gainStepDb);
  this->addNudge("Shallower", tr("Less Depth"), Qt::ALT + Qt::SHIFT + Qt::Key_PageUp, "DepthMm", -depthStepMm);
  this->addNudge("Deeper", tr("More Depth"), Qt::ALT + Qt::SHIFT + Qt::Key_PageDown, "DepthMm", depthStepMm);

  controls_->setObjectName("SonoScannerControls");
  rows_->setContentsMargins(4, 0, 4, 0);
  auto* buttons = new QGridLayout;
  int place = 0;
  for (QAction* act : { freezeAct_, storeAct, folderAct, flipAct, planeAct_, biplaneAct_ })
  {
    auto* button = new QToolButton;
    button->setDefaultAction(act);
    button->setObjectName(act == folderAct ? QString("Folder") : act->objectName().mid(int(strlen("actionSono"))));
    button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    buttons->addWidget(button, 0, place);
    ++place;
  }
  rows_->addLayout(buttons);
  rows_->addWidget(cine_);
  rows_->addWidget(path_);
  rows_->addWidget(beat_);
  QObject::connect(beat_, &pqSonoBeat::said, this, [this](const QString& sentence) { say(sentence); });
  QObject::connect(path_, &pqSonoPath::said, this, [this](const QString& sentence) { say(sentence); });
  QObject::connect(cine_, &pqSonoCine::scrubbed, this, &pqSonoScannerDock::scrub);
  QObject::connect(cine_, &pqSonoCine::played, this, &pqSonoScannerDock::playCine);
  // One alone moves the probe.
  QObject::connect(beat_, &pqSonoBeat::begins, this, [this] {
    path_->end();
    cine_->end();
  });
  QObject::connect(path_, &pqSonoPath::begins, this, [this] {
    beat_->end();
    cine_->end();
  });
  rows_->addStretch();

  message_->setObjectName("SonoScannerMessage");
  message_->setWordWrap(true);
  auto* contents = new QWidget;
  contents->setObjectName("SonoScannerContents");
  auto* all = new QVBoxLayout(contents);
  all->setContentsMargins(4, 4, 0, 4);
  all->addWidget(message_);
  scroll_->setObjectName("SonoScannerScroll");
  scroll_->setWidgetResizable(true);
  scroll_->setFrameShape(QFrame::NoFrame);
  scroll_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll_->setWidget(controls_);
  all->addWidget(scroll_);
  this->setWidget(contents);

  auto* active = &pqActiveObjects::instance();
  QObject::connect(active, &pqActiveObjects::sourceChanged, this, [this](pqPipelineSource* source) { follow(source); });
  QObject::connect(pqApplicationCore::instance()->getServerManagerModel(), &pqServerManagerModel::preSourceRemoved,
                   this, [this](pqPipelineSource* source) {
                     if (source == source_)
                     {
                       source_ = nullptr;
                       fill();
                     }
                   });
  QObject::connect(pqSonoKeptAlike::biplane(this), &pqSonoKeptAlike::changed, this, [this] { showPlane(); });
  QObject::connect(this, &QDockWidget::visibilityChanged, this, [this] { enable(); });
  this->toggleViewAction()->setObjectName("actionSonoScanner");
  this->toggleViewAction()->setIcon(QIcon(":/sono/scanner.svg"));
  this->toggleViewAction()->setToolTip(tr("The scanner's panel: depth, gain, freeze and the like"));
  // The tool bar may come later than this.
  QTimer::singleShot(0, this, [this] {
    if (auto* bar = pqCoreUtilities::mainWidget()->findChild<QToolBar*>("SonoToolBar"))
    {
      bar->addAction(this->toggleViewAction());
      bar->widgetForAction(this->toggleViewAction())->setObjectName("SonoScannerButton");
    }
  });
  this->hide(); // until it is asked for
  source_ = nullptr;
  this->fill();
  this->follow(active->activeSource());
}

QAction* pqSonoScannerDock::addAct(const char* name, const QString& text, const QKeySequence& key,
                                   const QString& toolTip)
{
  auto* act = new QAction(text, this);
  act->setObjectName(QString("actionSono") + name);
  act->setShortcut(key);
  act->setAutoRepeat(false);
  act->setToolTip(QString("%1 (%2)").arg(toolTip, key.toString(QKeySequence::NativeText)));
  pqCoreUtilities::mainWidget()->addAction(act); // wherever in the window the focus is
  acts_.push_back(act);
  return act;
}

void pqSonoScannerDock::addNudge(const char* name, const QString& text, const QKeySequence& key, const char* property,
                                 double step)
{
  QAction* act = this->addAct(name, text, key, text);
  act->setAutoRepeat(true);
  QObject::connect(act, &QAction::triggered, this, [this, property, step] { nudge(property, step); });
}

void pqSonoScannerDock::say(const QString& sentence)
{
  message_->setText(sentence);
  message_->setVisible(!sentence.isEmpty());
}

void pqSonoScannerDock::follow(pqPipelineSource* selected)
{
  const bool isOurs = selected && sonoIsUltrasound(selected->getProxy());
  if (isOurs && selected != source_) // another selection leaves it as it is
  {
    source_ = selected;
    this->fill();
  }
}

void pqSonoScannerDock::fill()
{
  delete settings_;
  for (const auto& [property, observer] : watched_)
  {
    if (property)
    {
      property->RemoveObserver(observer);
    }
  }
  watched_.clear();
  firstAxial_.clear();
  firstLateral_.clear();
  cine_->follow(source_);
  path_->follow(source_);
  beat_->follow(source_);
  if (source_)
  {
    settings_ = new SonoScannerSettings(
      source_->getProxy(), [this] { markChanged(); }, controls_);
    rows_->insertWidget(rows_->count() - 1, settings_);
    scroll_->setMinimumWidth(controls_->minimumSizeHint().width() + scroll_->verticalScrollBar()->sizeHint().width());
    this->watch("Lateral", SLOT(showPlane()));
    this->watch("ScanKind", SLOT(showPlane()));
    this->watch(sonoFreeze, SLOT(showFrozen()));
  }
  this->say(source_ ? QString() : tr("Select a Simulate Ultrasound in the pipeline browser; this panel then sets it."));
  this->enable();
}

void pqSonoScannerDock::watch(const char* property, const char* slot)
{
  vtkSMProperty* watched = source_->getProxy()->GetProperty(property);
  watched_.emplace_back(watched, pqCoreUtilities::connect(watched, vtkCommand::ModifiedEvent, this, slot));
}

/// Keys act while the panel can be seen.
void pqSonoScannerDock::enable()
{
  controls_->setEnabled(source_ != nullptr);
  for (QAction* act : acts_)
  {
    act->setEnabled(source_ && this->isVisible());
  }
  if (!this->isVisible())
  {
    cine_->end(); // which nobody could stop
  }
  this->showFrozen();
  this->showPlane();
}

void pqSonoScannerDock::showFrozen()
{
  const QSignalBlocker quiet(freezeAct_);
  const bool isFrozen = source_ && sonoIsFrozen(source_->getProxy());
  if (isFrozen && !freezeAct_->isChecked())
  {
    beat_->end(); // by an undo, say
  }
  freezeAct_->setChecked(isFrozen);
  cine_->setFrozen(isFrozen);
}

void pqSonoScannerDock::scrub(const SonoWindow& at, bool isOtherMoment)
{
  pqSonoProbeWidget* widget = played_ ? played_.data() : this->probeWidget();
  if (!widget || !widget->isLive())
  {
    cine_->end();
    return;
  }
  widget->goTo(at);
  if (isOtherMoment)
  {
    widget->showAgain();
  }
}

void pqSonoScannerDock::playCine(bool isPlaying)
{
  if (isPlaying && (played_ = this->probeWidget()) && played_->isLive())
  {
    beat_->end();
    path_->end();
    played_->hold(true);
    return;
  }
  if (isPlaying)
  {
    played_ = nullptr;
    this->say(pqSonoProbeWidget::tickLive());
    cine_->end();
  }
  else if (played_)
  {
    played_->hold(false);
    played_ = nullptr;
  }
}

/// As the properties panel does with each change of its own.
void pqSonoScannerDock::markChanged()
{
  if (source_ && source_->modifiedState() == pqProxy::UNMODIFIED)
  {
    source_->setModifiedState(pqProxy::MODIFIED);
  }
}

void pqSonoScannerDock::nudge(const char* property, double step)
{
  vtkSMUncheckedPropertyHelper number(source_->getProxy(), property);
  const bool isDepth = std::strcmp(property, "DepthMm") == 0;
  number.Set(isDepth ? std::max(number.GetAsDouble() + step, depthStepMm) : number.GetAsDouble() + step);
  this->markChanged();
}

void pqSonoScannerDock::freeze(bool frozen)
{
  if (frozen)
  {
    beat_->end();
  }
  {
    SCOPED_UNDO_SET(frozen ? tr("Freeze") : tr("Unfreeze"));
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", source_->getProxy());
    vtkSMPropertyHelper(source_->getProxy(), sonoFreeze).Set(frozen ? 1 : 0);
    source_->getProxy()->UpdateVTKObjects();
  }
  auto* panel = pqCoreUtilities::mainWidget()->findChild<pqPropertiesPanel*>();
  if (!frozen && panel && source_->modifiedState() == pqProxy::MODIFIED)
  {
    panel->apply(); // the scan goes on where the probe is now
  }
}

QString pqSonoScannerDock::folder() const
{
  return QString::fromUtf8(vtkSMPropertyHelper(source_->getProxy(), "StoreFolder").GetAsString());
}

bool pqSonoScannerDock::chooseFolder()
{
  // Where the filter runs: of a remote server, its folders.
  pqFileDialog dialog(source_->getServer(), pqCoreUtilities::mainWidget(), tr("Store pictures in"),
                      this->folder().isEmpty() ? folder_ : this->folder(), QString());
  dialog.setObjectName("SonoStoreDialog");
  dialog.setFileMode(pqFileDialog::Directory);
  if (dialog.exec() != QDialog::Accepted || dialog.getSelectedFiles().isEmpty())
  {
    return false;
  }
  this->storeIn(dialog.getSelectedFiles()[0]);
  return true;
}

void pqSonoScannerDock::storeIn(const QString& folder)
{
  folder_ = folder;
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", source_->getProxy());
  vtkSMPropertyHelper(source_->getProxy(), "StoreFolder").Set(folder.toUtf8().data());
  source_->getProxy()->UpdateVTKObjects();
}

void pqSonoScannerDock::store()
{
  if (this->folder().isEmpty())
  {
    SCOPED_UNDO_EXCLUDE(); // undo after a picture was stored goes back to what was done before it
    if (!folder_.isEmpty())
    {
      this->storeIn(folder_); // as of another filter
    }
    else if (!this->chooseFolder())
    {
      return;
    }
  }
  const QString time = QDateTime::currentDateTime().toString("yyyyMMdd_HHmmss_zzz");
  const QString file = QString("%1/ultrasound_%2.png").arg(this->folder(), time);
  const QString refusal = sonoStorePicture(vtkSMSourceProxy::SafeDownCast(source_->getProxy()), file);
  this->say(refusal.isEmpty() ? tr("Stored as %1.").arg(file) : refusal);
}

/// Whether it stands at a right angle to how it stood when the other plane was asked for, straight into the same place.
bool pqSonoScannerDock::isPlaneTurned() const
{
  if (firstLateral_.empty())
  {
    return false;
  }
  const std::vector<double> axial = numbersOf(source_, "Axial");
  const std::vector<double> lateral = numbersOf(source_, "Lateral");
  const auto cosine = [](const std::vector<double>& a, const std::vector<double>& b) {
    return dot(a, b) / std::sqrt(dot(a, a) * dot(b, b));
  };
  return cosine(axial, firstAxial_) > 0.999 && std::abs(cosine(lateral, firstLateral_)) < 0.05;
}

void pqSonoScannerDock::turnPlane()
{
  const bool back = this->isPlaneTurned();
  if (!back)
  {
    firstAxial_ = numbersOf(source_, "Axial");
    firstLateral_ = numbersOf(source_, "Lateral");
  }
  if (pqSonoProbeWidget* widget = this->probeWidget())
  {
    widget->turn(back ? -90.0 : 90.0);
  }
  this->showPlane();
}

void pqSonoScannerDock::showPlane()
{
  planeAct_->setEnabled(source_ && this->isVisible() && isVolumeProbe(source_));
  planeAct_->setChecked(source_ && this->isPlaneTurned());
  biplaneAct_->setChecked(source_ && sonoPlanesOf(source_).first);
  biplaneAct_->setEnabled(planeAct_->isEnabled() || (source_ && this->isVisible() && biplaneAct_->isChecked()));
}

void pqSonoScannerDock::toggleBiplane()
{
  const SonoPlanes planes = sonoPlanesOf(source_);
  pqPipelineSource* first = planes.first ? planes.first : source_.data();
  if (planes.first)
  {
    BEGIN_UNDO_SET(tr("End Biplane"));
    sonoEndBiplane(planes);
    END_UNDO_SET();
  }
  else
  {
    BEGIN_UNDO_SET(tr("Biplane"));
    const SonoSplit split = sonoShowBiplane(first);
    END_UNDO_SET();
    pqActiveObjects::instance().setActiveView(split.body); // where the probe can be seen and dragged
  }
  pqActiveObjects::instance().setActiveSource(first);
  pqApplicationCore::instance()->render();
  this->showPlane();
}

/// Of the source, in the properties panel.
pqSonoProbeWidget* pqSonoScannerDock::probeWidget() const
{
  return source_ ? sonoWidgetOf<pqSonoProbeWidget>(pqCoreUtilities::mainWidget(), source_->getProxy()) : nullptr;
}
