#pragma once

#include <QToolBar>

class pqPipelineSource;

/// The toolbar "Ultrasound": simulate the selected label map and show the layout, all in one click; show the layout of
/// the selected Simulate Ultrasound.
class pqSonoToolBar : public QToolBar
{
  Q_OBJECT

public:
  explicit pqSonoToolBar(QWidget* parent = nullptr);

private:
  void updateActions();
  void simulate();
  void showLayout();

  QAction* simulateAction_;
  QAction* layoutAction_;
};
