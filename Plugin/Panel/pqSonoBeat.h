#pragma once

#include <QElapsedTimer>
#include <QList>
#include <QPointer>
#include <QTimer>
#include <QWidget>

#include <functional>
#include <memory>

class QDoubleSpinBox;
class QPushButton;
class pqPipelineSource;
class pqSonoProbeWidget;
class SonoPhases;

/// Of the scanner's panel: plays the phases of a label map that moves at the heart's rate, again and again, as pictures
/// of a moving probe, which may be moved meanwhile. Where a picture takes longer than a phase, phases are left out, and
/// so they are until they have been made ready in the background.
class pqSonoBeat : public QWidget
{
  Q_OBJECT

public:
  /// `find` is asked for the widget that moves the probe of the source, when it is needed.
  explicit pqSonoBeat(std::function<pqSonoProbeWidget*()> find, QWidget* parent = nullptr);
  ~pqSonoBeat() override;

  /// Whose phases are played; none: nobody's.
  void follow(pqPipelineSource* source);
  /// As the button does while it plays.
  void end();

Q_SIGNALS:
  /// What a person should know, one sentence.
  void said(const QString& sentence);
  /// It holds the probe from now on.
  void begins();

private Q_SLOTS:
  void step();
  void showState();

private:
  void play(bool wanted);
  void stop();
  bool waitsFor(double time);
  QList<double> times() const;

  std::function<pqSonoProbeWidget*()> find_;
  QPointer<pqPipelineSource> source_;
  QPointer<pqSonoProbeWidget> widget_; // while it plays
  QPushButton* play_;
  QDoubleSpinBox* rate_;
  unsigned long rateSeen_ = 0;        // the observer of the source's
  std::unique_ptr<SonoPhases> ahead_; // until all are ready
  bool isPlaying_ = false;
  int phase_ = -1; // that is shown
  QElapsedTimer clock_;
  QTimer steps_;
};
