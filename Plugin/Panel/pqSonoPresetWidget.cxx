#include "pqSonoPresetWidget.h"

#include "SonoComboBox.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqFileDialog.h"
#include "pqServerManagerModel.h"
#include "vtkCommand.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSession.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMUncheckedPropertyHelper.h"
#include "vtkSmartPointer.h"

#include <QHBoxLayout>
#include <QSignalBlocker>

#include <algorithm>
#include <cmath>

namespace {

constexpr int firstSetting = 2; // column

enum Item
{
  OWN_NUMBERS = 0,
  FIRST_PRESET = 1
};

} // namespace

pqSonoPresetWidget::pqSonoPresetWidget(vtkSMProxy* smproxy, vtkSMProperty* property, QWidget* parentObject)
  : Superclass(smproxy, parentObject)
  , Choice(new SonoComboBox(this))
{
  this->setProperty(property);
  this->Choice->setObjectName("SonoPreset");
  this->Choice->setToolTip(pqPropertyWidget::getTooltip(property));
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->addWidget(this->Choice);
  this->readPresets(QString());
  const QStringList names = QStringList{ "PresetFile" } + this->Columns.mid(firstSetting);
  const auto has = [smproxy](const QString& name) { return smproxy->GetProperty(name.toUtf8().data()) != nullptr; };
  if (!std::all_of(names.begin(), names.end(), has))
  {
    this->Choice->setEnabled(false); // of a custom filter that shows the preset without its numbers
    return;
  }
  this->showChoice();
  QObject::connect(this->Choice, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
                   [this](int item) { choose(item); });
  for (const QString& name : names)
  {
    vtkSMProperty* setting = smproxy->GetProperty(name.toUtf8().data());
    for (const auto event : { vtkCommand::ModifiedEvent, vtkCommand::UncheckedPropertyModifiedEvent })
    {
      pqCoreUtilities::connect(setting, event, this, SLOT(showChoice()));
    }
  }
}

void pqSonoPresetWidget::apply()
{
  // The numbers have widgets of their own, which do this for them.
  this->Superclass::apply();
  const QString file = vtkSMUncheckedPropertyHelper(this->property()).GetAsString();
  vtkSMPropertyHelper(this->property()).Set(file.toUtf8().data());
  this->proxy()->UpdateVTKObjects();
}

void pqSonoPresetWidget::reset()
{
  this->Superclass::reset();
  this->property()->ClearUncheckedElements();
}

bool pqSonoPresetWidget::readPresets(const QString& file)
{
  auto presets = vtkSmartPointer<vtkSMSourceProxy>::Take(
    vtkSMSourceProxy::SafeDownCast(this->proxy()->GetSessionProxyManager()->NewProxy("sources", "SonoProbePresets")));
  vtkSMPropertyHelper(presets, "FileName").Set(file.toUtf8().data());
  presets->UpdateVTKObjects();
  presets->UpdatePipeline();
  presets->UpdatePropertyInformation();
  const vtkSMPropertyHelper refusal(presets, "Refusal");
  if (refusal.GetNumberOfElements() > 0 && *refusal.GetAsString())
  {
    return false; // the source has said why
  }
  this->Presets.clear();
  const vtkSMPropertyHelper rows(presets, "Rows");
  for (unsigned int i = 0; i < rows.GetNumberOfElements(); ++i)
  {
    this->Presets << QString::fromUtf8(rows.GetAsString(i)).split('\t');
  }
  this->Columns = this->Presets.isEmpty() ? QStringList() : this->Presets.takeFirst();
  return true;
}

bool pqSonoPresetWidget::isShown(const QStringList& preset) const
{
  for (int i = firstSetting; i < this->Columns.size(); ++i)
  {
    vtkSMUncheckedPropertyHelper setting(this->proxy(), this->Columns[i].toUtf8().data());
    const double value = preset[i].toDouble();
    if (std::abs(setting.GetAsDouble() - value) > 1e-6 * std::abs(value))
    {
      return false;
    }
  }
  return true;
}

void pqSonoPresetWidget::showChoice()
{
  const QSignalBlocker quiet(this->Choice);
  const QString named = vtkSMUncheckedPropertyHelper(this->proxy(), "PresetFile").GetAsString();
  this->Choice->clear();
  this->Choice->addItem(named.isEmpty() ? tr("Own numbers") : named);
  int shown = OWN_NUMBERS;
  for (const QStringList& preset : this->Presets)
  {
    this->Choice->addItem(preset[1]);
    if (named.isEmpty() && shown == OWN_NUMBERS && this->isShown(preset))
    {
      shown = this->Choice->count() - 1;
    }
  }
  this->Choice->addItem(tr("Custom file..."));
  this->Choice->setCurrentIndex(shown);
}

void pqSonoPresetWidget::choose(int item)
{
  if (item == this->Choice->count() - 1)
  {
    this->chooseFile();
  }
  else if (item >= FIRST_PRESET)
  {
    this->fill(this->Presets[item - FIRST_PRESET]);
  }
  this->showChoice();
}

void pqSonoPresetWidget::chooseFile()
{
  // Where the data are: of a remote server, its files.
  pqServer* server = pqApplicationCore::instance()->getServerManagerModel()->findServer(this->proxy()->GetSession());
  pqFileDialog dialog(server, pqCoreUtilities::mainWidget(), tr("Choose a probe preset"), QString(),
                      tr("Probe presets (*.json)"));
  dialog.setObjectName("SonoPresetDialog");
  dialog.setFileMode(pqFileDialog::ExistingFile);
  if (dialog.exec() == QDialog::Accepted && !dialog.getSelectedFiles().isEmpty() &&
      this->readPresets(dialog.getSelectedFiles()[0]))
  {
    this->fill(this->Presets.last());
  }
}

void pqSonoPresetWidget::fill(const QStringList& preset)
{
  vtkSMUncheckedPropertyHelper(this->proxy(), "PresetFile").Set("");
  for (int i = firstSetting; i < this->Columns.size(); ++i)
  {
    vtkSMUncheckedPropertyHelper(this->proxy(), this->Columns[i].toUtf8().data()).Set(preset[i].toDouble());
  }
  Q_EMIT this->changeAvailable();
  Q_EMIT this->changeFinished();
}
