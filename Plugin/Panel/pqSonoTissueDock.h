#pragma once

#include "SonoTissueModel.h"

#include <QDockWidget>
#include <QPointer>

class QLabel;
class QPushButton;
class QTableWidget;
class pqPipelineSource;

/// The tissue editor: the labels of the selected Ultrasound Scene or Simulate Ultrasound with name, colour, tissue and
/// the tissue's numbers. What is typed is refused in place where it will not do; tried, it becomes the filter's tables
/// without a file, one step of undo, which the editor follows; saved, on the server where there is one, its files.
class pqSonoTissueDock : public QDockWidget
{
  Q_OBJECT

public:
  explicit pqSonoTissueDock(QWidget* parent = nullptr);

private:
  void load();
  void showTables();
  void follow();
  void use(const QStringList& tables);
  void fill();
  void showValues();
  void change(int row, int column, const QString& text);
  void tryOut();
  void save();
  void say(const QString& sentence);

  SonoTissueModel model_;
  QPointer<pqPipelineSource> source_;
  QStringList tables_; // of the filter, whose labels and tissues these are
  QTableWidget* table_;
  QLabel* message_;
  QPushButton* tryButton_;
  QPushButton* saveButton_;
  bool filling_ = false; // no change is a person's
};
