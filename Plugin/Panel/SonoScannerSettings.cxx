#include "SonoScannerSettings.h"

#include "pqDoubleLineEdit.h"
#include "pqPropertyWidget.h"
#include "pqPropertyWidgetDecorator.h"
#include "pqProxyWidget.h"
#include "vtkPVXMLElement.h"
#include "vtkSMProperty.h"
#include "vtkSMProxy.h"

#include <QCoreApplication>
#include <QGridLayout>
#include <QLabel>

#include <algorithm>
#include <cstring>

namespace {

constexpr int numberWidth = 64;

/// A property, by the name that it has on a scanner.
struct Knob
{
  const char* property;
  const char* label;
};

const Knob knobs[] = { { "PresetFile", QT_TRANSLATE_NOOP("SonoScannerSettings", "Probe") },
                       { "ImagingMode", QT_TRANSLATE_NOOP("SonoScannerSettings", "Mode") },
                       { "CentreFrequencyMHz", QT_TRANSLATE_NOOP("SonoScannerSettings", "Frequency (MHz)") },
                       { "DepthMm", QT_TRANSLATE_NOOP("SonoScannerSettings", "Depth (mm)") },
                       { "TransmitFocusMm", QT_TRANSLATE_NOOP("SonoScannerSettings", "Focus (mm)") },
                       { "SectorDeg", QT_TRANSLATE_NOOP("SonoScannerSettings", "Sector (deg)") },
                       { "WidthMm", QT_TRANSLATE_NOOP("SonoScannerSettings", "Width (mm)") },
                       { "GainDb", QT_TRANSLATE_NOOP("SonoScannerSettings", "Gain (dB)") },
                       { "DynamicRangeDb", QT_TRANSLATE_NOOP("SonoScannerSettings", "Range (dB)") },
                       { "GreyMap", QT_TRANSLATE_NOOP("SonoScannerSettings", "Grey Map") },
                       { "TargetErrorDb", QT_TRANSLATE_NOOP("SonoScannerSettings", "Error (dB)") },
                       { "TgcDbPerCm", QT_TRANSLATE_NOOP("SonoScannerSettings", "TGC (dB/cm)") },
                       { "Tgc1Db", QT_TRANSLATE_NOOP("SonoScannerSettings", "TGC 1, near") },
                       { "Tgc2Db", QT_TRANSLATE_NOOP("SonoScannerSettings", "TGC 2") },
                       { "Tgc3Db", QT_TRANSLATE_NOOP("SonoScannerSettings", "TGC 3") },
                       { "Tgc4Db", QT_TRANSLATE_NOOP("SonoScannerSettings", "TGC 4") },
                       { "Tgc5Db", QT_TRANSLATE_NOOP("SonoScannerSettings", "TGC 5") },
                       { "Tgc6Db", QT_TRANSLATE_NOOP("SonoScannerSettings", "TGC 6") },
                       { "Tgc7Db", QT_TRANSLATE_NOOP("SonoScannerSettings", "TGC 7") },
                       { "Tgc8Db", QT_TRANSLATE_NOOP("SonoScannerSettings", "TGC 8, far (dB)") } };

/// Those that the hints of its property name.
QList<pqPropertyWidgetDecorator*> decorate(pqPropertyWidget* widget)
{
  QList<pqPropertyWidgetDecorator*> decorators;
  vtkPVXMLElement* hints = widget->property()->GetHints();
  for (unsigned int i = 0; hints && i < hints->GetNumberOfNestedElements(); ++i)
  {
    vtkPVXMLElement* hint = hints->GetNestedElement(i);
    if (hint->GetName() && std::strcmp(hint->GetName(), "PropertyWidgetDecorator") == 0)
    {
      if (auto* decorator = pqPropertyWidgetDecorator::create(hint, widget))
      {
        decorators.append(decorator);
      }
    }
  }
  return decorators;
}

} // namespace

SonoScannerSettings::SonoScannerSettings(vtkSMProxy* ultrasound, const std::function<void()>& changed, QWidget* parent)
  : QWidget(parent)
{
  this->setObjectName("SonoScannerSettings");
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setVerticalSpacing(2);
  grid->setColumnStretch(1, 1);
  for (const Knob& knob : knobs)
  {
    this->addRow(grid, ultrasound, knob.property, knob.label, changed);
  }
}

void SonoScannerSettings::addRow(QGridLayout* grid, vtkSMProxy* ultrasound, const char* name, const char* text,
                                 const std::function<void()>& changed)
{
  vtkSMProperty* property = ultrasound->GetProperty(name);
  pqPropertyWidget* widget = property ? pqProxyWidget::createWidgetForProperty(property, ultrasound, this) : nullptr;
  if (!widget)
  {
    return; // of a custom filter that does not show it
  }
  widget->setObjectName(name);
  auto* label = new QLabel(QCoreApplication::translate("SonoScannerSettings", text), this);
  label->setToolTip(QString("<p>%1: %2</p>").arg(property->GetXMLLabel(), pqPropertyWidget::getTooltip(property)));
  widget->setToolTip(label->toolTip());
  for (auto* part : widget->findChildren<QWidget*>())
  {
    part->setAccessibleName(label->text());
  }
  for (auto* number : widget->findChildren<pqDoubleLineEdit*>())
  {
    number->setMaximumWidth(numberWidth); // the room is the slider's
  }
  const int row = grid->rowCount();
  grid->addWidget(label, row, 0);
  grid->addWidget(widget, row, 1);
  QObject::connect(widget, &pqPropertyWidget::changeAvailable, this, changed);

  const QList<pqPropertyWidgetDecorator*> decorators = decorate(widget);
  const auto showIfUsed = [decorators, label, widget] {
    const bool isUsed = std::all_of(decorators.begin(), decorators.end(),
                                    [](pqPropertyWidgetDecorator* each) { return each->canShowWidget(true); });
    label->setVisible(isUsed);
    widget->setVisible(isUsed);
  };
  for (pqPropertyWidgetDecorator* decorator : decorators)
  {
    QObject::connect(decorator, &pqPropertyWidgetDecorator::visibilityChanged, this, showIfUsed);
  }
  showIfUsed();
}
