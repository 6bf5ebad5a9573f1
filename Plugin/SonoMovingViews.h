#pragma once

#include "SonoKeptDrawing.h"

#include <QList>
#include <QMap>
#include <QPair>
#include <QPointer>

#include "vtkCommand.h"
#include "vtkSmartPointer.h"
#include "vtkWeakPointer.h"

#include <memory>

class pqDataRepresentation;
class pqView;
class vtkObject;
class vtkSMProxy;

/**
 * How the visible views are drawn while a probe moves or a setting of the display is being turned.
 *
 * After each picture ParaView gathers what there is to choose from in panels, from all that is shown; that takes longer
 * than to draw it. So the proxies of representations do not learn that these ran, and find out what there is to choose
 * from when all rests. Nor do the anatomy and the flat image's scale run, which do not change with the pose
 * (SonoKeptDrawing).
 *
 * Where drawing itself is slow, as in software, a slow view shows fewer triangles, as when it is turned, without
 * peeling and without smoothed edges, in the light of one lamp, at every second picture only, and charts wait until
 * drawInFull.
 */
class SonoMovingViews
{
public:
  /// Of the source's proxy, at each picture on the way: its own UpdateDataEvent does not come before all rests.
  enum
  {
    PictureShownEvent = vtkCommand::UserEvent + 532
  };

  /// The visible views. To be called before the source changes.
  explicit SonoMovingViews(vtkSMProxy* source);
  /// Unless drawInFull was called, all is made anew with the next picture, the anatomy as well.
  ~SonoMovingViews();

  /// Makes the few triangles of a slow view beforehand, so that the first picture on the way need not wait for them.
  static void prepare(pqView* view);

  /// Runs the pipeline and shows a picture on the way.
  void draw();
  /// The same of another grey: slow views wait until all rests, unless there are no others, and what does not show
  /// greys stays as it is.
  void drawGrey();
  /// Has the picture of the probe that rests on the screen, in slow views as on the way, so that it need not wait until
  /// these are drawn in full; then drawInFull.
  void drawRested();
  /// From now on the views are drawn as when nothing moves. Does not draw.
  void drawInFull();

private:
  Q_DISABLE_COPY(SonoMovingViews)

  void take(pqView* view);
  void mute(vtkSMProxy* representation);
  void unmute();
  enum class Marked
  {
    All,
    ButAnatomy,
    Grey
  };
  bool isMarked(const pqDataRepresentation* shown, Marked which) const;
  void markModified(pqView* view, Marked which);
  bool drawQuick(Marked which = Marked::ButAnatomy);
  void lighten();
  void makeLamp();

  vtkSmartPointer<vtkSMProxy> Source;
  std::unique_ptr<SonoKeptDrawing> Anatomy;                     // until drawInFull
  std::unique_ptr<SonoKeptDrawing> Scale;                       // the same
  unsigned long ScaleWatch = 0;                                 // over what it shows
  QList<QPointer<pqView>> Views;                                // the slow ones last
  QList<QPointer<pqView>> Slow;                                 // of them
  vtkSmartPointer<vtkSMProxy> Lamp;                             // which lights these
  QMap<pqView*, QList<QPointer<pqDataRepresentation>>> Shown;   // by the views
  QList<QPair<vtkWeakPointer<vtkObject>, unsigned long>> Muted; // with their observers
  int Pictures = 0;                                             // on the way so far
};
