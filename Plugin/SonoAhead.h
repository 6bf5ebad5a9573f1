#pragma once

#include <QList>
#include <QPair>
#include <QString>
#include <QVector>

class vtkSMProxy;

/**
 * Which pose of a moving probe is drawn while the picture of the next one is computed (vtkSonoUltrasound::MakeAhead):
 * one picture behind the hand, and as many more a second as drawing takes time. Where the filter runs in ParaView's own
 * process, on the CPU; elsewhere each pose is drawn as it comes.
 */
class SonoAhead
{
public:
  /// As properties of the source, PositionMm, Axial, Lateral and others.
  using Pose = QList<QPair<QString, QVector<double>>>;

  explicit SonoAhead(vtkSMProxy* source);

  /// Nothing is drawn yet of what comes.
  void restart();
  /// The same, and the probe will move from here: what its first picture needs is made ready.
  void restart(const Pose& here);
  /// The pose to draw, where the probe has got to `now`; none while it is being computed: ask again a moment later.
  Pose toDraw(const Pose& now);
  /// Whether another is to be drawn, even if the probe moves no further.
  bool isWaiting() const { return !this->Next.isEmpty(); }

private:
  Q_DISABLE_COPY(SonoAhead)

  bool begin(const Pose& pose);
  bool isOther(const Pose& pose) const;

  vtkSMProxy* Source;
  Pose Drawn; // last; empty: none
  Pose Next;  // is being computed, or has been; empty: none
};
