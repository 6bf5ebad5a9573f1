#pragma once

#include <QElapsedTimer>
#include <QList>
#include <QObject>
#include <QPointer>
#include <QWidget>

/**
 * While a hand moves a probe: panels, tool bars and the status bar with its progress are painted with a picture, and at
 * most four times a second.
 *
 * Qt puts a window with views together anew whatever of it is painted, which takes software a tenth of the time that a
 * picture takes. Numbers that follow the pointer, the state of Apply and the progress of a filter did so several times
 * a picture.
 */
class SonoHeldPanels : public QObject
{
public:
  /// Those of the main window, from now until this is gone.
  SonoHeldPanels();
  ~SonoHeldPanels() override;

  /// After a picture: once, unless they were a moment ago.
  void paintOnce();
  bool event(QEvent* happened) override;

private:
  Q_DISABLE_COPY(SonoHeldPanels)

  void paint(bool wanted);

  QList<QPointer<QWidget>> Panels;
  QElapsedTimer SincePainted;
};
