#pragma once

#include <QPointer>
#include <QToolBar>

class pqPipelineSource;
struct SonoExample;

/// The toolbar "Ultrasound": simulate the selected label map and show the layout, all in one click; show the layout of
/// the selected Simulate Ultrasound; put a needle into its picture; show one of the examples. One whose first run was
/// stopped is laid out once Apply has made its picture.
class pqSonoToolBar : public QToolBar
{
  Q_OBJECT

public:
  explicit pqSonoToolBar(QWidget* parent = nullptr);

private:
  void updateActions();
  void simulate();
  void showLayout();
  void showUnshown();
  void showNeedle();
  void addExamples();
  void showExample(const SonoExample& example);

  QAction* simulateAction_;
  QAction* layoutAction_;
  QAction* needleAction_;
  QPointer<pqPipelineSource> unshown_; // waits for its first picture
};
