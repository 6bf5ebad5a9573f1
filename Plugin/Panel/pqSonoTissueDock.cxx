#include "pqSonoTissueDock.h"

#include "SonoComboBox.h"

#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"
#include "vtkSonoUltrasound.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqColorChooserButton.h"
#include "pqCoreUtilities.h"
#include "pqFileDialog.h"
#include "pqPipelineSource.h"
#include "pqUndoStack.h"

#include <QAction>
#include <QBrush>
#include <QColor>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QTableWidget>
#include <QToolTip>
#include <QVBoxLayout>

#include <cstring>

namespace {

/// What the filter's labels and tissues come from.
const char* const tableProperties[] = { "LabelTableFile", "TissueTableFile", "LabelTableText", "TissueTableText" };

QStringList tablesOf(pqPipelineSource* source)
{
  QStringList tables;
  for (const char* name : tableProperties)
  {
    tables << QString::fromUtf8(vtkSMPropertyHelper(source->getProxy(), name).GetAsString());
  }
  return tables;
}

bool isA(pqPipelineSource* source, const char* name)
{
  return source && std::strcmp(source->getProxy()->GetXMLName(), name) == 0;
}

} // namespace

pqSonoTissueDock::pqSonoTissueDock(QWidget* parent)
  : QDockWidget(tr("Ultrasound Tissues"), parent)
  , table_(new QTableWidget)
  , message_(new QLabel)
  , tryButton_(new QPushButton(tr("Try")))
  , saveButton_(new QPushButton(tr("Save and Use...")))
{
  table_->setObjectName("SonoTissueTable");
  table_->setMinimumWidth(460); // number, name, colour and tissue beside each other
  message_->setObjectName("SonoTissueMessage");
  message_->setWordWrap(true);
  saveButton_->setObjectName("SonoTissueSave");
  saveButton_->setToolTip(tr("Write the label table and the tissue table as CSV files and have the filter use them"));
  tryButton_->setObjectName("SonoTissueTry");
  tryButton_->setToolTip(tr("Have the filter use what stands here without writing files; Undo takes it back"));
  auto* loadButton = new QPushButton(tr("Load Selected"));
  loadButton->setObjectName("SonoTissueLoad");
  loadButton->setToolTip(tr("Show the labels of the selected Ultrasound Scene or Simulate Ultrasound"));

  auto* contents = new QWidget;
  contents->setObjectName("SonoTissueContents");
  auto* rows = new QVBoxLayout(contents);
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(loadButton);
  buttons->addWidget(tryButton_);
  buttons->addWidget(saveButton_);
  buttons->addStretch();
  rows->addLayout(buttons);
  rows->addWidget(table_);
  rows->addWidget(message_);
  this->setWidget(contents);

  tryButton_->setEnabled(false);
  saveButton_->setEnabled(false);
  say(tr("Select an Ultrasound Scene or a Simulate Ultrasound in the pipeline browser and load it."));
  QObject::connect(loadButton, &QPushButton::clicked, this, [this] { load(); });
  QObject::connect(tryButton_, &QPushButton::clicked, this, [this] { tryOut(); });
  QObject::connect(saveButton_, &QPushButton::clicked, this, [this] { save(); });
  QObject::connect(table_, &QTableWidget::cellChanged, this,
                   [this](int row, int column) { change(row, column, table_->item(row, column)->text()); });
  this->toggleViewAction()->setObjectName("actionSonoTissues");
  this->hide(); // until it is asked for in the menu View
}

void pqSonoTissueDock::say(const QString& sentence)
{
  message_->setText(sentence);
}

void pqSonoTissueDock::load()
{
  pqPipelineSource* selected = pqActiveObjects::instance().activeSource();
  const bool isAll = isA(selected, "SonoUltrasound");
  if (!isAll && !isA(selected, "SonoSceneBuilder"))
  {
    return say(tr("What is selected is no Ultrasound Scene and no Simulate Ultrasound; select one and load it."));
  }
  source_ = selected;
  if (pqUndoStack* steps = pqApplicationCore::instance()->getUndoStack())
  {
    QObject::connect(steps, &pqUndoStack::undone, this, &pqSonoTissueDock::follow, Qt::UniqueConnection);
    QObject::connect(steps, &pqUndoStack::redone, this, &pqSonoTissueDock::follow, Qt::UniqueConnection);
  }
  showTables();
}

void pqSonoTissueDock::follow()
{
  if (source_ && tablesOf(source_) != tables_)
  {
    showTables();
  }
}

void pqSonoTissueDock::showTables()
{
  tables_ = tablesOf(source_);
  const unsigned int port = isA(source_, "SonoUltrasound") ? static_cast<unsigned int>(vtkSonoUltrasound::ANATOMY) : 0;
  const bool loaded = model_.load(vtkSMSourceProxy::SafeDownCast(source_->getProxy()), port);
  tryButton_->setEnabled(loaded);
  saveButton_->setEnabled(loaded);
  const QString guesses = model_.guesses();
  say(loaded ? (guesses.isEmpty() ? QString() : tr("Guesses, to be looked at: %1. ").arg(guesses)) +
                 tr("Choose colours and tissues, type into the other fields. Numbers belong to the tissue: all its "
                    "labels have them.")
             : tr("%1 has no labels yet; apply it and load it again.").arg(source_->getSMName()));
  fill();
}

void pqSonoTissueDock::fill()
{
  filling_ = true;
  const QStringList columns = model_.columns();
  const QStringList tissues = model_.tissueNames();
  table_->clear();
  table_->setRowCount(model_.rowCount());
  table_->setColumnCount(columns.size());
  table_->setHorizontalHeaderLabels(columns);
  for (int column = 0; column < columns.size(); ++column)
  {
    table_->horizontalHeaderItem(column)->setToolTip(model_.meaning(column));
  }
  table_->verticalHeader()->hide();
  for (int row = 0; row < model_.rowCount(); ++row)
  {
    for (int column = 0; column < columns.size(); ++column)
    {
      auto* item = new QTableWidgetItem;
      const bool isTyped = column == SonoTissueModel::NAME || column >= SonoTissueModel::FIRST_NUMBER;
      item->setFlags(isTyped ? item->flags() | Qt::ItemIsEditable : item->flags() & ~Qt::ItemIsEditable);
      table_->setItem(row, column, item);
    }
    auto* color = new pqColorChooserButton(table_);
    color->setObjectName(QString("SonoColor_%1").arg(row));
    color->setToolTip(tr("The label's colour"));
    QObject::connect(color, &pqColorChooserButton::chosenColorChanged, this,
                     [this, row](const QColor& chosen) { change(row, SonoTissueModel::COLOR, chosen.name()); });
    table_->setCellWidget(row, SonoTissueModel::COLOR, color);
    auto* tissue = new SonoComboBox(table_);
    tissue->setObjectName(QString("SonoTissue_%1").arg(row));
    tissue->setToolTip(tr("The tissue that the label is made of"));
    tissue->addItems(tissues);
    QObject::connect(tissue, &QComboBox::currentTextChanged, this,
                     [this, row](const QString& chosen) { change(row, SonoTissueModel::TISSUE, chosen); });
    table_->setCellWidget(row, SonoTissueModel::TISSUE, tissue);
  }
  showValues();
  table_->resizeColumnsToContents();
}

void pqSonoTissueDock::showValues()
{
  filling_ = true;
  for (int row = 0; row < table_->rowCount(); ++row)
  {
    for (int column = 0; column < table_->columnCount(); ++column)
    {
      const QString text = model_.value(row, column);
      if (column == SonoTissueModel::COLOR)
      {
        qobject_cast<pqColorChooserButton*>(table_->cellWidget(row, column))->setChosenColor(QColor(text));
      }
      else if (column == SonoTissueModel::TISSUE)
      {
        qobject_cast<QComboBox*>(table_->cellWidget(row, column))->setCurrentText(text);
      }
      else
      {
        QTableWidgetItem* item = table_->item(row, column);
        item->setText(text);
        const bool isMarked = column <= SonoTissueModel::NAME && model_.isGuess(row);
        item->setBackground(isMarked ? QBrush(QColor("#f9e79f")) : QBrush());
        item->setForeground(isMarked ? QBrush(Qt::black) : QBrush());
        item->setToolTip(isMarked ? tr("Its tissue is a guess: choose another, or save to keep it") : QString());
      }
    }
  }
  filling_ = false;
}

void pqSonoTissueDock::change(int row, int column, const QString& text)
{
  if (filling_)
  {
    return;
  }
  const QString refusal = model_.setValue(row, column, text);
  message_->setStyleSheet(refusal.isEmpty() ? "" : "color: #c0392b");
  say(refusal.isEmpty() ? tr("Changed; try it, or save to use it.") : refusal);
  if (!refusal.isEmpty())
  {
    table_->scrollToItem(table_->item(row, column));
    const QRect cell = table_->visualItemRect(table_->item(row, column));
    QToolTip::showText(table_->viewport()->mapToGlobal(cell.bottomLeft()), refusal, table_);
  }
  showValues(); // the old text where it was refused, other labels of the tissue where it was not
}

void pqSonoTissueDock::use(const QStringList& tables)
{
  vtkSMProxy* proxy = source_->getProxy();
  {
    SCOPED_UNDO_SET(tr("Change Tissues"));
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", proxy);
    for (int i = 0; i < tables.size(); ++i)
    {
      vtkSMPropertyHelper(proxy, tableProperties[i]).Set(tables[i].toUtf8().data());
    }
    proxy->UpdateVTKObjects();
  }
  tables_ = tables;
  source_->updatePipeline();
  source_->renderAllViews();
}

void pqSonoTissueDock::tryOut()
{
  if (!source_)
  {
    return say(tr("What these tissues belong to was deleted; select another one and load it."));
  }
  message_->setStyleSheet("");
  use({ tables_[0], tables_[1], model_.labelText(), model_.tissueText() });
  say(tr("%1 uses this now; no file was written. Save to keep it.").arg(source_->getSMName()));
}

void pqSonoTissueDock::save()
{
  if (!source_)
  {
    return say(tr("What these tissues belong to was deleted; select another one and load it."));
  }
  // Where the filter reads them: of a remote server, its files.
  pqFileDialog dialog(source_->getServer(), pqCoreUtilities::mainWidget(), tr("Save the tissues"), QString(),
                      tr("Tables (*.csv)"));
  dialog.setObjectName("SonoTissueSaveDialog");
  dialog.setFileMode(pqFileDialog::AnyFile);
  if (dialog.exec() != QDialog::Accepted || dialog.getSelectedFiles().isEmpty())
  {
    return;
  }
  QString stem = dialog.getSelectedFiles()[0];
  stem.chop(stem.endsWith(".csv") ? 4 : 0);
  const QString labels = stem + "_labels.csv";
  const QString tissues = stem + "_tissues.csv";
  const QString refusal = model_.save(labels, tissues);
  message_->setStyleSheet(refusal.isEmpty() ? "" : "color: #c0392b");
  if (!refusal.isEmpty())
  {
    return say(refusal);
  }
  use({ labels, tissues, QString(), QString() });
  say(tr("Saved as %1 and %2, which %3 uses now.").arg(labels, tissues, source_->getSMName()));
}
