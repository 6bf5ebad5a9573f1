#include "pqSonoProbeWidget.h"

#include "SonoFlatView.h"
#include "SonoFreeze.h"
#include "SonoMovingViews.h"
#include "SonoProbeGroup.h"
#include "SonoWaiting.h"
#include "SonoWindows.h"
#include "pqSonoLiveSettings.h"
#include "pqSonoWindowFinder.h"
#include "vtkSonoProbeRepresentation.h"
#include "vtkSonoSkin.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqDoubleLineEdit.h"
#include "pqPipelineSource.h"
#include "pqPropertiesPanel.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "pqView.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSession.h"
#include "vtkSMSessionClient.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"
#include "vtkSMUncheckedPropertyHelper.h"

#include <QCheckBox>
#include <QCoreApplication>
#include <QDoubleSpinBox>
#include <QGridLayout>
#include <QGuiApplication>
#include <QLabel>
#include <QPushButton>
#include <QToolButton>

#include <string>
#include <utility>

namespace {

constexpr int restMs = 150; // more than keys that are held take to repeat
constexpr int idleMs = 500; // more than settings take to come to rest
const char* const poseFunctions[] = { "PositionMm", "Axial", "Lateral", "DepthMm" };

/// Which has an anatomy.
bool isUltrasound(vtkSMProxy* proxy)
{
  return proxy->GetXMLName() == std::string("SonoUltrasound");
}
} // namespace

pqSonoProbeWidget::pqSonoProbeWidget(vtkSMProxy* smproxy, vtkSMPropertyGroup* group, QWidget* parentObject)
  : Superclass("representations", "SonoProbeWidgetRepresentation", smproxy, sonoLayout(smproxy, group), parentObject)
  , Refining(smproxy)
{
  // Somebody may drag this probe. It is no change of an image and waits for no Apply.
  vtkSMPropertyHelper(smproxy, "PrepareInteraction", true).Set(1);
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setSpacing(4);
  for (const char* function : poseFunctions)
  {
    this->addRow(grid, function);
  }
  const int row = grid->rowCount();
  this->Step = new QDoubleSpinBox(this);
  this->Step->setObjectName("Step");
  this->Step->setRange(0.1, 90.0);
  this->Step->setDecimals(1);
  this->Step->setValue(5.0);
  this->Step->setSuffix(" degrees");
  this->Step->setToolTip(tr("How far one click on a button below turns the probe, 0.1 to 90 degrees."));
  grid->addWidget(new QLabel(tr("Turn by"), this), row, 0);
  grid->addWidget(this->Step, row, 1, 1, 3);
  this->addTurn(grid, row + 1, tr("Rotate"),
                tr("About the probe's axis. In the view: drag the yellow ring, or Ctrl + left, right."),
                &vtkSonoProbeRepresentation::Rotate);
  this->addTurn(grid, row + 2, tr("Tilt"),
                tr("Out of the image plane. In the view: drag the green ball, or Shift + up, down."),
                &vtkSonoProbeRepresentation::Tilt);
  this->addTurn(grid, row + 3, tr("Rock"),
                tr("In the image plane. In the view: drag the blue ball, or Shift + left, right."),
                &vtkSonoProbeRepresentation::Rock);

  auto* snapButton = new QPushButton(tr("Snap to Skin"), this);
  snapButton->setObjectName("SnapToSkin");
  snapButton->setToolTip(tr("Puts the face on the outermost surface along the probe's axis and looks straight in."));
  this->connect(snapButton, SIGNAL(clicked()), SLOT(snap()));
  auto* resetButton = new QPushButton(tr("Reset"), this);
  resetButton->setObjectName("ResetPose");
  resetButton->setToolTip(isUltrasound(smproxy)
                            ? tr("The pose that was found first for this body, as that of a new Simulate Ultrasound.")
                            : tr("The default pose: the apical four-chamber view of the Thorax Phantom."));
  this->connect(resetButton, SIGNAL(clicked()), SLOT(resetPose()));
  grid->addWidget(snapButton, row + 4, 0, 1, 2);
  grid->addWidget(resetButton, row + 4, 2, 1, 2);

  auto* show = new QCheckBox(tr("Show Probe"), this);
  show->setObjectName("ShowProbe");
  show->setChecked(true);
  show->setToolTip(tr(
    "Shows the transducer in the view. Drag it along the skin; its balls and its ring turn it; the violet ball at the "
    "far end of the fan sets the depth. While the pointer is over it, the arrow keys walk by 1 mm, with Shift they "
    "rock and tilt, with Ctrl they rotate and change the depth."));
  this->Live = new QCheckBox(tr("Live"), this);
  this->Live->setObjectName("Live");
  this->Live->setChecked(true);
  this->Live->setToolTip(tr("Scans while the probe moves, in full when it rests; shows the display's settings, as the "
                            "gain, with each step; and scans when depth, sector, frequency, focus, lines or a preset "
                            "were changed. Off: as it stands on Apply."));
  new pqSonoLiveSettings(
    smproxy, [this] { return this->isLive(); }, [this] { return this->mayScan() && !this->Moving; },
    [this] { this->Refining.begin(); }, this);
  grid->addWidget(show, row + 5, 0, 1, 2);
  grid->addWidget(this->Live, row + 5, 2, 1, 2);
  if (isUltrasound(smproxy))
  {
    auto* finder = new pqSonoWindowFinder(smproxy, this->widgetProxy(), this);
    grid->addWidget(finder, row + 6, 0, 1, 4);
    this->connect(finder, &pqSonoWindowFinder::chosen, this, &pqSonoProbeWidget::stand);
    this->connect(finder, &pqSonoWindowFinder::said, this, [this](const QString& said) { this->showMessage(said); });
  }
  this->Message = new QLabel(this);
  this->Message->setObjectName("Message");
  this->Message->setWordWrap(true);
  this->Message->hide();
  grid->addWidget(this->Message, row + 7, 0, 1, 4);

  this->connect(show, SIGNAL(toggled(bool)), SLOT(setWidgetVisible(bool)));
  show->connect(this, SIGNAL(widgetVisibilityToggled(bool)), SLOT(setChecked(bool)));
  this->setWidgetVisible(show->isChecked());

  this->Frame.setSingleShot(true);
  this->Frame.setInterval(0);
  this->connect(&this->Frame, SIGNAL(timeout()), SLOT(showMoving()));
  this->Rest.setSingleShot(true);
  this->Rest.setInterval(restMs);
  this->connect(&this->Rest, SIGNAL(timeout()), SLOT(rest()));
  this->Prepare.setSingleShot(true);
  this->Prepare.setInterval(idleMs);
  this->connect(&this->Prepare, SIGNAL(timeout()), SLOT(prepare()));
  this->connect(this, SIGNAL(startInteraction()), SLOT(start()));
  this->connect(this, SIGNAL(interaction()), SLOT(move()));
  this->connect(this, &pqInteractivePropertyWidget::endInteraction, this, [this] { this->finish(); });
  this->connect(pqApplicationCore::instance()->getServerManagerModel(), &pqServerManagerModel::preSourceRemoved, this,
                [this](pqPipelineSource* source) { this->Surfaces.forget(source->getProxy()); });
}

pqSonoProbeWidget::~pqSonoProbeWidget() = default;

void pqSonoProbeWidget::addRow(QGridLayout* grid, const char* function)
{
  vtkSMProperty* smproperty = this->propertyGroup()->GetProperty(function);
  if (!smproperty)
  {
    return;
  }
  const int row = grid->rowCount();
  auto* label = new QLabel(QCoreApplication::translate("ServerManagerXML", smproperty->GetXMLLabel()), this);
  grid->addWidget(label, row, 0);
  const int count = static_cast<int>(vtkSMPropertyHelper(smproperty).GetNumberOfElements());
  for (int i = 0; i < count; ++i)
  {
    auto* edit = new pqDoubleLineEdit(this);
    edit->setObjectName(count > 1 ? QString("%1_%2").arg(function).arg(i) : function);
    edit->setToolTip(pqPropertyWidget::getTooltip(smproperty));
    label->setToolTip(edit->toolTip());
    this->addPropertyLink(edit, "text2", SIGNAL(textChangedAndEditingFinished()), smproperty, i);
    this->connect(edit, &pqDoubleLineEdit::textChangedAndEditingFinished, this, [this] { this->showMessage(""); });
    grid->addWidget(edit, row, i + 1, 1, count > 1 ? 1 : 3);
  }
}

void pqSonoProbeWidget::addTurn(QGridLayout* grid, int row, const QString& name, const QString& toolTip,
                                void (vtkSonoProbeRepresentation::*turn)(double))
{
  grid->addWidget(new QLabel(name, this), row, 0);
  for (const int sign : { -1, 1 })
  {
    auto* button = new QToolButton(this);
    button->setObjectName(name + (sign < 0 ? "Minus" : "Plus"));
    button->setText(sign < 0 ? QString(QChar(0x2212)) : "+");
    button->setToolTip(toolTip);
    button->setAutoRepeat(true);
    button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    grid->addWidget(button, row, sign < 0 ? 1 : 2);
    this->connect(button, &QToolButton::clicked, this, [this, sign, turn] {
      this->start();
      (this->probe()->*turn)(sign * this->Step->value());
      this->takePose();
    });
  }
}

vtkSonoProbeRepresentation* pqSonoProbeWidget::probe() const
{
  return vtkSonoProbeRepresentation::SafeDownCast(this->widgetProxy()->GetRepresentationProxy()->GetClientSideObject());
}

bool pqSonoProbeWidget::isLive() const
{
  auto* source = pqApplicationCore::instance()->getServerManagerModel()->findItem<pqProxy*>(this->proxy());
  // What was never applied has nothing to show yet.
  return this->Live->isChecked() && source && source->modifiedState() != pqProxy::UNINITIALIZED;
}

/// While it is frozen, only what the scanner's panel asks for.
bool pqSonoProbeWidget::mayScan() const
{
  return this->isLive() && (this->Asked || !sonoIsFrozen(this->proxy()));
}

void pqSonoProbeWidget::turn(double degrees)
{
  this->Asked = true;
  this->start();
  this->probe()->Rotate(degrees);
  this->takePose();
}

void pqSonoProbeWidget::goTo(const SonoWindow& place)
{
  this->Asked = true;
  this->stand(place);
}

void pqSonoProbeWidget::start()
{
  this->Refining.pause();
  this->findSkin();
  if (!this->Moving)
  {
    auto* source = pqApplicationCore::instance()->getServerManagerModel()->findItem<pqProxy*>(this->proxy());
    this->WasApplied = source && source->modifiedState() == pqProxy::UNMODIFIED;
    this->PoseBefore.clear();
    for (const char* function : poseFunctions)
    {
      if (vtkSMProperty* smproperty = this->propertyGroup()->GetProperty(function))
      {
        const std::vector<double> values = vtkSMPropertyHelper(smproperty).GetDoubleArray();
        this->PoseBefore.append({ function, QVector<double>(values.begin(), values.end()) });
      }
    }
    this->Moving = true;
    if (!this->Shown && this->mayScan() && !this->proxy()->GetSession()->GetPendingProgress())
    {
      this->Shown = std::make_unique<SonoMovingViews>(this->proxy()); // before the probe itself is drawn
    }
  }
  this->Rest.stop();
}

void pqSonoProbeWidget::move()
{
  this->showMessage();
  if (this->mayScan() && !this->Frame.isActive())
  {
    this->Frame.start();
  }
}

void pqSonoProbeWidget::finish()
{
  this->showMessage();
  this->Rest.start();
}

void pqSonoProbeWidget::showMoved()
{
  Q_EMIT this->changeAvailable();
  this->render();
  this->move();
  this->finish();
}

void pqSonoProbeWidget::takePose()
{
  vtkSonoProbeRepresentation* moved = this->probe();
  vtkSMProxy* widget = this->widgetProxy();
  vtkSMPropertyHelper(widget, "PositionMm").Set(moved->GetPositionMm(), 3);
  vtkSMPropertyHelper(widget, "Axial").Set(moved->GetAxial(), 3);
  vtkSMPropertyHelper(widget, "Lateral").Set(moved->GetLateral(), 3);
  widget->UpdateVTKObjects();
  this->showMoved();
}

void pqSonoProbeWidget::snap()
{
  this->start();
  this->probe()->SnapToSkin();
  this->takePose();
}

void pqSonoProbeWidget::resetPose()
{
  if (isUltrasound(this->proxy()))
  {
    const SonoWindows found = sonoFindWindows(vtkSMSourceProxy::SafeDownCast(this->proxy()), SonoWindowsOf::Input, "");
    if (!found.windows.empty())
    {
      this->stand({ "", "", 0.0, found.windows.front().pose }); // with the probe and the depth that there are
    }
    this->showMessage(QString::fromStdString(found.refusal));
    return;
  }
  this->start();
  for (const char* function : poseFunctions)
  {
    vtkSMProperty* smproperty = this->propertyGroup()->GetProperty(function);
    vtkSMProperty* ofWidget = this->widgetProxy()->GetProperty(function);
    if (smproperty && ofWidget && function != QString("DepthMm"))
    {
      ofWidget->ResetToXMLDefaults();
    }
  }
  this->widgetProxy()->UpdateVTKObjects();
  this->showMoved();
}

void pqSonoProbeWidget::stand(const SonoWindow& window)
{
  this->start();
  vtkSMProxy* widget = this->widgetProxy();
  vtkSMPropertyHelper(widget, "PositionMm").Set(window.pose.data(), 3);
  vtkSMPropertyHelper(widget, "Axial").Set(window.pose.data() + 3, 3);
  vtkSMPropertyHelper(widget, "Lateral").Set(window.pose.data() + 6, 3);
  if (window.depthMm > 0.0)
  {
    vtkSMPropertyHelper(widget, "DepthMm").Set(window.depthMm);
  }
  widget->UpdateVTKObjects();
  if (!window.preset.empty())
  {
    // As if it had been chosen among the presets; the depth is the window's.
    vtkSMUncheckedPropertyHelper(this->proxy(), "PresetFile").Set("");
    for (const auto& [name, value] : sonoPresetNumbers(this->proxy()->GetSessionProxyManager(), window.preset))
    {
      if (name != "DepthMm")
      {
        vtkSMUncheckedPropertyHelper(this->proxy(), name.c_str()).Set(value);
      }
    }
  }
  this->showMoved();
}

void pqSonoProbeWidget::showMessage()
{
  this->showMessage(this->probe()->GetMessage());
}

void pqSonoProbeWidget::showMessage(const QString& message)
{
  this->Message->setText(message);
  this->Message->setVisible(!message.isEmpty());
}

QList<QPair<QString, QVector<double>>> pqSonoProbeWidget::pose() const
{
  QList<QPair<QString, QVector<double>>> values;
  for (const auto& [function, before] : this->PoseBefore)
  {
    const std::vector<double> now = vtkSMPropertyHelper(this->widgetProxy(), function.toUtf8().data()).GetDoubleArray();
    values.append({ function, QVector<double>(now.begin(), now.end()) });
  }
  return values;
}

void pqSonoProbeWidget::push(const QList<QPair<QString, QVector<double>>>& values, bool preview)
{
  for (const auto& [function, numbers] : values)
  {
    vtkSMProperty* smproperty = this->propertyGroup()->GetProperty(function.toUtf8().data());
    vtkSMPropertyHelper(smproperty).Set(numbers.data(), static_cast<unsigned int>(numbers.size()));
  }
  vtkSMPropertyHelper(this->proxy(), "Preview", true).Set(preview ? 1 : 0);
  this->proxy()->UpdateVTKObjects();
}

void pqSonoProbeWidget::showMoving()
{
  if (!this->mayScan() || !this->Moving)
  {
    return;
  }
  if (this->proxy()->GetSession()->GetPendingProgress())
  {
    this->Frame.start(); // not while something runs
    return;
  }
  if (!this->Shown)
  {
    this->Shown = std::make_unique<SonoMovingViews>(this->proxy());
  }
  {
    SCOPED_UNDO_EXCLUDE();
    this->push(this->pose(), true);
  }
  this->Shown->draw();
}

void pqSonoProbeWidget::rest()
{
  if (!this->Moving)
  {
    return;
  }
  const bool isScrubbed = this->Asked && QGuiApplication::mouseButtons() != Qt::NoButton; // a slider is held
  if (isScrubbed || this->proxy()->GetSession()->GetPendingProgress())
  {
    this->Rest.start();
    return;
  }
  this->Frame.stop();
  this->Moving = false;
  std::unique_ptr<SonoMovingViews> shown = std::move(this->Shown);
  const bool wanted = this->mayScan();
  this->Asked = false;
  if (!wanted)
  {
    return;
  }
  const auto after = this->pose();
  this->Refining.begin();
  std::unique_ptr<SonoKeptAnatomy> anatomy;
  if (sonoAnyWaits(this->proxy()))
  {
    shown.reset(); // what is applied with the pose may change the anatomy
  }
  else if (shown)
  {
    {
      SCOPED_UNDO_EXCLUDE();
      this->push(after, false);
    }
    shown->drawRested(); // what follows makes nothing of the picture anew
    anatomy = std::make_unique<SonoKeptAnatomy>(this->proxy());
  }
  {
    // So that undo finds the pose before the movement, not one on the way.
    SCOPED_UNDO_EXCLUDE();
    this->push(this->PoseBefore, false);
  }
  auto* panel = pqCoreUtilities::mainWidget()->findChild<pqPropertiesPanel*>();
  if (panel && this->WasApplied)
  {
    // As if the new pose had been typed and applied.
    for (const auto& [function, numbers] : after)
    {
      vtkSMPropertyHelper(this->widgetProxy(), function.toUtf8().data())
        .Set(numbers.data(), static_cast<unsigned int>(numbers.size()));
    }
    this->widgetProxy()->UpdateVTKObjects();
    Q_EMIT this->changeAvailable();
    panel->apply();
    return;
  }
  {
    // Something else waits for Apply and goes on waiting.
    SCOPED_UNDO_SET(tr("Move Probe"));
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", this->proxy());
    this->push(after, false);
  }
  pqApplicationCore::instance()->render();
}

void pqSonoProbeWidget::setView(pqView* next)
{
  if (next && sonoIsFlatView(next->getProxy())) // where a fan in space has no place; it stays where it is
  {
    return;
  }
  if (this->view())
  {
    this->view()->disconnect(&this->Prepare);
  }
  this->Superclass::setView(next);
  if (this->view())
  {
    // What is shown may have changed.
    this->Prepare.connect(this->view(), SIGNAL(endRender()), SLOT(start()));
  }
}

void pqSonoProbeWidget::prepare()
{
  // Not from a server: all that is shown would come over unasked.
  if (!this->Moving && this->isWidgetVisible() && !vtkSMSessionClient::SafeDownCast(this->proxy()->GetSession()) &&
      !this->proxy()->GetSession()->GetPendingProgress())
  {
    this->findSkin();
    this->probe()->GetSkin()->Prepare();
    if (this->view())
    {
      SonoMovingViews::prepare(this->view());
    }
  }
}

void pqSonoProbeWidget::findSkin()
{
  SCOPED_UNDO_EXCLUDE(); // nobody wants to undo that data were looked at
  vtkNew<vtkMultiBlockDataSet> surfaces;
  if (this->view())
  {
    this->Surfaces.collect(*this->view(), this->proxy(), surfaces);
  }
  this->probe()->GetSkin()->SetSurfaces(surfaces);
}
