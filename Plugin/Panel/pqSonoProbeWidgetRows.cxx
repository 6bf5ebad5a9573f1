#include "SonoMovingViews.h"
#include "SonoProbeGroup.h"
#include "pqSonoLiveSettings.h"
#include "pqSonoProbeWidget.h"
#include "pqSonoWindowFinder.h"
#include "vtkSonoProbeRepresentation.h"

#include "pqApplicationCore.h"
#include "pqDoubleLineEdit.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "vtkSMPropertyHelper.h"

#include <QCheckBox>
#include <QCoreApplication>
#include <QDoubleSpinBox>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QToolButton>

namespace {

constexpr int untilReadyMs = 4;      // little of what a picture takes
constexpr int restMs = 150;          // more than keys that are held take to repeat
constexpr int untilPreparedMs = 500; // more than settings take to come to rest

} // namespace

pqSonoProbeWidget::pqSonoProbeWidget(vtkSMProxy* smproxy, vtkSMPropertyGroup* group, QWidget* parentObject)
  : Superclass("representations", "SonoProbeWidgetRepresentation", smproxy, sonoLayout(smproxy, group), parentObject)
  , Ahead(smproxy)
  , Refining(smproxy)
{
  // Somebody may drag this probe. It is no change of an image and waits for no Apply.
  vtkSMPropertyHelper(smproxy, "PrepareInteraction", true).Set(1);
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setSpacing(4);
  for (const char* function : PoseFunctions)
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
  this->Step->setAccessibleName(tr("Turn by"));
  grid->addWidget(new QLabel(this->Step->accessibleName(), this), row, 0);
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
  resetButton->setToolTip(this->isUltrasound()
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
    "far end of the fan sets the depth. Where that view has the keyboard, the arrow keys walk by 1 mm, with Shift they "
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
  if (this->isUltrasound())
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
  this->Look.setSingleShot(true);
  this->Look.setInterval(untilReadyMs);
  this->connect(&this->Look, SIGNAL(timeout()), SLOT(showMoving()));
  this->Rest.setSingleShot(true);
  this->Rest.setInterval(restMs);
  this->connect(&this->Rest, SIGNAL(timeout()), SLOT(rest()));
  this->Prepare.setSingleShot(true);
  this->Prepare.setInterval(untilPreparedMs);
  this->connect(&this->Prepare, SIGNAL(timeout()), SLOT(prepare()));
  this->connect(this, SIGNAL(startInteraction()), SLOT(grip()));
  this->connect(this, SIGNAL(interaction()), SLOT(move()));
  this->connect(this, &pqInteractivePropertyWidget::endInteraction, this, [this] { this->finish(); });
  this->connect(pqApplicationCore::instance()->getServerManagerModel(), &pqServerManagerModel::preSourceRemoved, this,
                [this](pqPipelineSource* source) { this->Surfaces.forget(source->getProxy()); });
}

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
    edit->setAccessibleName(count > 1 ? QString("%1 %2").arg(label->text(), QString("xyz"[i])) : label->text());
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
    button->setAccessibleName(QString("%1 %2").arg(name, button->text()));
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
