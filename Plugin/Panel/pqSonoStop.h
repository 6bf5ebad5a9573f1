#pragma once

#include "SonoInterruption.h"

#include <QElapsedTimer>
#include <QObject>
#include <QPointer>
#include <QTimer>

#include <memory>
#include <utility>
#include <vector>

class QEvent;
class SonoServerStops;
class QWindow;
class pqPipelineSource;
class pqProxy;

/// Lets ParaView's abort button (and Escape) stop our filters while they run, in the GUI's own process or on a server.
/// ParaView 5.11 shows progress but handles no events meanwhile; this handles them, several times a second, while one
/// of our filters works. Only the button, Escape and closing the window are acted on, which stops the run. Other input
/// waits for its end, as it does without us; timers wait, too, so that nothing starts a run inside a run. While a mouse
/// button that was pressed before the run is held, as in a drag, nothing is handled at all.
///
/// The filter that was stopped goes on showing what it made before, and waits for Apply.
class pqSonoStop
  : public QObject
  , public sono::Interrupter
{
  Q_OBJECT

public:
  explicit pqSonoStop(QObject* parent = nullptr);
  ~pqSonoStop() override;

  /// Whether a source was stopped and waits for Apply since.
  static bool waits(const pqProxy* source);

  /// Called by ParaView when the plugin is loaded and when ParaView ends.
  void startup();
  void shutdown();

  bool wantsStop() override;
  void hasStopped(vtkAlgorithm* filter) override;
  void hasFinished(vtkAlgorithm* filter) override;

protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

private:
  void begin();
  void end();
  void settle();
  void settleServers(QStringList& names);
  bool await(pqPipelineSource* source);
  void offerApply();
  void runAgain(pqProxy* applied);
  void look();
  bool isOnButton(QEvent* event) const;

  bool busy_ = false;     // ParaView shows progress
  bool dragging_ = false; // since before that
  bool looking_ = false;  // events are handled just now
  bool stop_ = false;
  QElapsedTimer sinceBegin_;
  QElapsedTimer sinceLook_;
  qint64 lastLookMs_ = 0; // how long it took
  QTimer afterwards_;     // back in the event loop
  QPointer<QWindow> closing_;
  std::vector<std::pair<QPointer<QObject>, std::unique_ptr<QEvent>>> held_;
  std::vector<vtkAlgorithm*> stopped_; // not told to the user yet
  std::vector<QPointer<pqPipelineSource>> waiting_;
  std::unique_ptr<SonoServerStops> servers_;
};
