#pragma once

#include <QList>
#include <QPointer>

class pqDataRepresentation;
class pqView;
class vtkSMProxy;

/**
 * How the visible views are drawn while a probe moves.
 *
 * ParaView takes it that whatever a filter shows changes with each of its settings. The anatomy that Simulate
 * Ultrasound passes on does not change with the pose, but making millions of triangles ready to be drawn takes longer
 * than the simulation. So what was drawn of it is kept as long as this object lives. Where drawing itself is slow, as
 * in software, a slow view shows few triangles, without peeling and without smoothed edges, at every second picture
 * only, and charts wait until drawInFull.
 */
class SonoMovingViews
{
public:
  /// Of the visible views, keeps the anatomy that this source passes on if it is Simulate Ultrasound.
  explicit SonoMovingViews(vtkSMProxy* source);
  /// What the source makes from now on is drawn again; what it was marked with before is not.
  ~SonoMovingViews();

  /// Runs the pipeline and shows a picture on the way.
  void draw();
  /// From now on the views are drawn as when nothing moves. Does not draw.
  void drawInFull();

private:
  Q_DISABLE_COPY(SonoMovingViews)

  void keepAnatomy();
  void letGo();
  void lighten();

  vtkSMProxy* Source;
  QList<QPointer<pqDataRepresentation>> Kept;
  QList<QPointer<pqView>> Views;
  QList<QPointer<pqView>> Slow; // of them
  int Pictures = 0;             // on the way so far
};
