#pragma once

#include "SonoProbePaths.h"

#include <QElapsedTimer>
#include <QPointer>
#include <QTimer>
#include <QWidget>

#include <functional>
#include <vector>

class QGridLayout;
class QPushButton;
class pqPipelineSource;
class pqSonoProbeWidget;

/// Of the scanner's panel: records the way of a probe that is moved by hand as a Probe Path; moves the probe along one
/// in its own time; makes a sweep of it and a data set's file.
class pqSonoPath : public QWidget
{
  Q_OBJECT

public:
  /// `find` is asked for the widget that moves the probe of the source, when it is needed.
  explicit pqSonoPath(std::function<pqSonoProbeWidget*()> find, QWidget* parent = nullptr);

  /// Whose probe is recorded and moved; none: nobody's.
  void follow(pqPipelineSource* source);
  /// No longer plays.
  void end();

Q_SIGNALS:
  /// What a person should know, one sentence.
  void said(const QString& sentence);
  /// It holds the probe from now on.
  void begins();

private Q_SLOTS:
  void take();
  void step();
  void showState();

private:
  QPushButton* addButton(QGridLayout* grid, const char* name, const QString& text, const QString& toolTip);
  void record(bool wanted);
  void play(bool wanted);
  void makeSweep();
  void writeDataSet();
  pqPipelineSource* lastPath() const;

  std::function<pqSonoProbeWidget*()> find_;
  QPointer<pqPipelineSource> source_;
  QPointer<pqSonoProbeWidget> widget_; // while it is recorded or moved
  QPushButton* record_;
  QPushButton* play_;
  QPushButton* sweep_;
  QPushButton* dataSet_;
  std::vector<SonoTimedPose> poses_; // that are being recorded, or played
  QElapsedTimer clock_;
  QTimer steps_;
};
