#ifndef pqSonoPresetWidget_h
#define pqSonoPresetWidget_h

#include "pqPropertyWidget.h"

#include <QStringList>
#include <QVector>

class QComboBox;

/// The probes to choose from. A choice fills in the probe's numbers, which wait for Apply as if they had been typed;
/// and numbers that are a preset's show its name. A file that a script named stands there as it is until one chooses.
class pqSonoPresetWidget : public pqPropertyWidget
{
  Q_OBJECT
  using Superclass = pqPropertyWidget;

public:
  pqSonoPresetWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);

  void apply() override;
  void reset() override;

private Q_SLOTS:
  void showChoice();

private:
  Q_DISABLE_COPY(pqSonoPresetWidget)

  /// The presets, and that of a file with them; false when the file will not do, which has been said then.
  bool readPresets(const QString& file);
  void choose(int item);
  void chooseFile();
  void fill(const QStringList& preset);
  bool isShown(const QStringList& preset) const;

  QComboBox* Choice;
  QStringList Columns;          // Preset, Name, and the settings
  QVector<QStringList> Presets; // fields of these
};

#endif
