#pragma once

#include "SonoWindows.h"

#include <QElapsedTimer>
#include <QPointer>
#include <QWidget>

#include <deque>

class QLabel;
class QSlider;
class pqPipelineSource;

/// The cine loop of the scanner's panel: the last poses at which a moving probe scanned. While the picture is frozen a
/// scrubber goes back to them; the same pose gives the same picture, since its chance belongs to the lines. And how
/// many pictures a second came while the probe moved.
class pqSonoCine : public QWidget
{
  Q_OBJECT

public:
  explicit pqSonoCine(QWidget* parent = nullptr);

  /// Whose poses are kept from now on; those of another are forgotten. None: nobody's.
  void follow(pqPipelineSource* source);
  void setFrozen(bool frozen);

Q_SIGNALS:
  /// By hand, to a pose and its depth.
  void scrubbed(const SonoWindow& at);

private Q_SLOTS:
  void look();

private:
  void showState();

  QPointer<pqPipelineSource> source_;
  unsigned long shown_ = 0; // the observer of its pictures
  std::deque<SonoWindow> poses_;
  std::deque<qint64> times_; // of the last pictures, ms
  QElapsedTimer clock_;
  QSlider* scrubber_;
  QLabel* place_;
  QLabel* rate_;
  bool frozen_ = false;
};
