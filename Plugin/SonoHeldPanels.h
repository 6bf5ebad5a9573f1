#pragma once

#include <QList>
#include <QObject>
#include <QPointer>
#include <QTimer>
#include <QWidget>

/**
 * While a mouse drags a probe: panels, tool bars and the status bar with its progress are painted four times a second.
 *
 * Qt puts a window with views together anew whatever of it is painted, which takes software a tenth of the time that a
 * picture takes. Numbers that follow the pointer, the state of Apply and the progress of a filter did so several times
 * a picture.
 */
class SonoHeldPanels : public QObject
{
public:
  /// Those of the main window, from now on until this is gone or no button of the mouse is down any more.
  SonoHeldPanels();
  ~SonoHeldPanels() override;

  bool event(QEvent* happened) override;

private:
  Q_DISABLE_COPY(SonoHeldPanels)

  void look();
  void paint(bool wanted);

  QList<QPointer<QWidget>> Panels;
  QTimer Look;
};
