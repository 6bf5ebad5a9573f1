#pragma once

#include "SonoWindows.h"

#include <QElapsedTimer>
#include <QPointer>
#include <QTimer>
#include <QWidget>

#include <deque>

class QLabel;
class QPushButton;
class QSlider;
class pqPipelineSource;

/// The cine loop of the scanner's panel: where the probe stood in the last pictures of a moving probe or a beating
/// heart, and when. While the picture is frozen a scrubber goes back to them, and they play; the same pose and moment
/// give the same picture, since its chance belongs to the lines. And how many pictures a second came while the probe
/// moved.
class pqSonoCine : public QWidget
{
  Q_OBJECT

public:
  explicit pqSonoCine(QWidget* parent = nullptr);

  /// Whose poses are kept from now on; those of another are forgotten. None: nobody's.
  void follow(pqPipelineSource* source);
  void setFrozen(bool frozen);
  /// As the button does while it plays.
  void end();

Q_SIGNALS:
  /// To a pose and its depth, and maybe to another moment of the anatomy, which is set by then.
  void scrubbed(const SonoWindow& at, bool isOtherMoment);
  /// Pictures follow each other until it is told that they do not.
  void played(bool isPlaying);

private Q_SLOTS:
  void look();

private:
  /// What a picture was of, and when it came.
  struct Picture
  {
    SonoWindow at;
    double moment;
    qint64 shownMs;
  };

  void showState();
  void goTo(int place);
  void play(bool wanted);
  int meanIntervalMs() const;

  QPointer<pqPipelineSource> source_;
  unsigned long shown_ = 0; // the observer of its pictures
  std::deque<Picture> pictures_;
  std::deque<qint64> times_; // of the last pictures, ms
  QElapsedTimer clock_;
  QTimer steps_;   // while it plays
  QTimer settled_; // after another moment
  QPushButton* play_;
  QSlider* scrubber_;
  QLabel* place_;
  QLabel* rate_;
  bool frozen_ = false;
  bool awaits_ = false; // the picture that is asked for while it plays
};
