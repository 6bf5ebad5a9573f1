#include "SonoTissueModel.h"

#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSmartPointer.h"
#include "vtkSonoLabelTable.h"

#include <QColor>
#include <QLocale>

#include <algorithm>

namespace {

QVector<QStringList> rowsOf(vtkSMProxy* table, const char* property)
{
  const vtkSMPropertyHelper rows(table, property);
  QVector<QStringList> result;
  for (unsigned int i = 0; i < rows.GetNumberOfElements(); ++i)
  {
    result << QString::fromUtf8(rows.GetAsString(i)).split('\t');
  }
  return result;
}

QString csvRow(const QStringList& fields)
{
  QStringList quoted;
  for (QString field : fields)
  {
    const bool plain = !field.contains(',') && !field.contains('"');
    quoted << (plain ? field : '"' + field.replace('"', "\"\"") + '"');
  }
  return quoted.join(',') + '\n';
}

QString writeFile(vtkSMSessionProxyManager* manager, const QString& path, const QString& text)
{
  auto file = vtkSmartPointer<vtkSMProxy>::Take(manager->NewProxy("misc", "SonoTextFile"));
  vtkSMPropertyHelper(file, "FileName").Set(path.toUtf8().data());
  vtkSMPropertyHelper(file, "Text").Set(text.toUtf8().data());
  file->UpdateVTKObjects();
  file->InvokeCommand("Write");
  file->UpdatePropertyInformation();
  return QString::fromUtf8(vtkSMPropertyHelper(file, "Refusal").GetAsString());
}

} // namespace

bool SonoTissueModel::load(vtkSMSourceProxy* scene, unsigned int port)
{
  labels_.clear();
  tissues_.clear();
  manager_ = scene->GetSessionProxyManager();
  auto table = vtkSmartPointer<vtkSMSourceProxy>::Take(
    vtkSMSourceProxy::SafeDownCast(manager_->NewProxy("filters", "SonoLabelTable")));
  vtkSMPropertyHelper(table, "Input").Set(scene, port);
  table->UpdateVTKObjects();
  table->UpdatePipeline();
  table->UpdatePropertyInformation();
  const QVector<QStringList> labels = rowsOf(table, "LabelRows");
  for (int i = 1; i < labels.size(); ++i)
  {
    const QStringList& row = labels[i];
    const QColor color(row[2].toInt(), row[3].toInt(), row[4].toInt());
    labels_ << Label{ row[0], row[1], color.name(), row[5], !row[6].isEmpty() };
  }
  std::stable_partition(labels_.begin(), labels_.end(), [](const Label& label) { return label.isGuess; });
  tissues_ = rowsOf(table, "TissueRows");
  if (!tissues_.isEmpty())
  {
    tissueColumns_ = tissues_.takeFirst();
  }
  return !labels_.isEmpty();
}

QStringList SonoTissueModel::columns() const
{
  return QStringList{ "id", "name", "colour", "tissue" } + tissueColumns_.mid(1, tissueColumns_.size() - 2);
}

QString SonoTissueModel::guesses() const
{
  QStringList texts;
  for (const Label& label : labels_)
  {
    if (label.isGuess)
    {
      texts << QString("%1 (%2)").arg(label.name, label.tissue);
    }
  }
  return texts.join(", ");
}

QStringList SonoTissueModel::tissueNames() const
{
  QStringList names;
  for (const QStringList& tissue : tissues_)
  {
    names << tissue[0];
  }
  return names;
}

const QStringList* SonoTissueModel::tissueNamed(const QString& name) const
{
  for (const QStringList& tissue : tissues_)
  {
    if (tissue[0] == name)
    {
      return &tissue;
    }
  }
  return nullptr;
}

QString SonoTissueModel::value(int row, int column) const
{
  const Label& label = labels_[row];
  switch (column)
  {
    case ID:
      return label.id;
    case NAME:
      return label.name;
    case COLOR:
      return label.color;
    case TISSUE:
      return label.tissue;
    default:
      return tissueNamed(label.tissue)->at(1 + column - FIRST_NUMBER);
  }
}

QString SonoTissueModel::setTissueNumber(const QString& name, int column, const QString& text)
{
  bool isNumber = false;
  const double value = QLocale::c().toDouble(text, &isNumber);
  const QString& columnName = tissueColumns_[column];
  if (!isNumber)
  {
    return QObject::tr("'%1' is no number; write one for %2 of the tissue '%3'.").arg(text, columnName, name);
  }
  const std::string refusal = vtkSonoLabelTable::Refusal(name.toStdString(), columnName.toStdString(), value);
  if (!refusal.empty())
  {
    return QString::fromStdString(refusal);
  }
  for (QStringList& tissue : tissues_)
  {
    if (tissue[0] == name)
    {
      tissue[column] = text;
      tissue.last() = "chosen: edited in ParaView";
    }
  }
  return {};
}

QString SonoTissueModel::setValue(int row, int column, const QString& text)
{
  Label& label = labels_[row];
  if (column >= FIRST_NUMBER)
  {
    return setTissueNumber(label.tissue, 1 + column - FIRST_NUMBER, text.trimmed());
  }
  const QString field = text.trimmed();
  if (column == NAME)
  {
    if (field.isEmpty())
    {
      return QObject::tr("Label %1 has no name; write one.").arg(label.id);
    }
    label.name = field;
  }
  else if (column == COLOR)
  {
    const QColor color(field);
    if (!color.isValid())
    {
      return QObject::tr("'%1' is no colour; write one as #rrggbb, or its English name.").arg(field);
    }
    label.color = color.name();
  }
  else if (column == TISSUE)
  {
    if (!tissueNamed(field))
    {
      return QObject::tr("There is no tissue '%1'; choose one of %2.").arg(field, tissueNames().join(", "));
    }
    label.tissue = field;
    label.isGuess = false;
  }
  return {};
}

QString SonoTissueModel::meaning(int column) const
{
  const int number = 1 + column - FIRST_NUMBER;
  return number < 1 ? QString()
                    : QString::fromStdString(vtkSonoLabelTable::Meaning(tissueColumns_[number].toStdString()));
}

QString SonoTissueModel::labelText() const
{
  QString labels = "id,name,r,g,b,tissue\n";
  for (const Label& label : labels_)
  {
    const QColor color(label.color);
    labels += csvRow({ label.id, label.name, QString::number(color.red()), QString::number(color.green()),
                       QString::number(color.blue()), label.tissue });
  }
  return labels;
}

QString SonoTissueModel::tissueText() const
{
  QString tissues = csvRow(tissueColumns_);
  for (const QStringList& tissue : tissues_)
  {
    tissues += csvRow(tissue);
  }
  return tissues;
}

QString SonoTissueModel::save(const QString& labelFile, const QString& tissueFile) const
{
  if (!manager_)
  {
    return QObject::tr("The server that these tissues come from is gone; load them again.");
  }
  const QString refusal = writeFile(manager_, labelFile, labelText());
  return refusal.isEmpty() ? writeFile(manager_, tissueFile, tissueText()) : refusal;
}
