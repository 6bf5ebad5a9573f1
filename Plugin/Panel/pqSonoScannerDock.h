#pragma once

#include "vtkWeakPointer.h"

#include <QDockWidget>
#include <QPointer>
#include <QStringList>

#include <utility>
#include <vector>

class QAction;
class QKeySequence;
class QLabel;
class QScrollArea;
class QVBoxLayout;
class pqPipelineSource;
class pqSonoBeat;
class pqSonoCine;
class pqSonoPath;
class pqSonoProbeWidget;
class vtkSMProperty;
struct SonoWindow;

/// The scanner's panel: the properties of the Simulate Ultrasound that was selected last that a sonographer knows, in
/// ParaView's own widgets, and freeze, cine loop, store, flip and the other plane. Like the properties panel it changes
/// what waits for Apply; "Live" (pqSonoLiveSettings, pqSonoProbeWidget) then shows it. Its keys act while it is open.
class pqSonoScannerDock : public QDockWidget
{
  Q_OBJECT

public:
  explicit pqSonoScannerDock(QWidget* parent = nullptr);

private Q_SLOTS:
  void showPlane();
  void showFrozen();

private:
  /// A key, and what it does; none of them repeats while it is held but those of `nudge`.
  QAction* addAct(const char* name, const QString& text, const QKeySequence& key, const QString& toolTip);
  void addNudge(const char* name, const QString& text, const QKeySequence& key, const char* property, double step);
  void follow(pqPipelineSource* selected);
  void fill();
  void watch(const char* property, const char* slot);
  void enable();
  void markChanged();
  void nudge(const char* property, double step);
  void freeze(bool frozen);
  void store();
  QString folder() const;
  bool chooseFolder();
  void storeIn(const QString& folder);
  void turnPlane();
  void toggleBiplane();
  void playCine(bool isPlaying);
  void scrub(const SonoWindow& at, bool isOtherMoment);
  bool isPlaneTurned() const;
  pqSonoProbeWidget* probeWidget() const;
  void say(const QString& sentence);

  QPointer<pqPipelineSource> source_;
  std::vector<QAction*> acts_;
  QAction* freezeAct_;
  QAction* planeAct_;
  QAction* biplaneAct_;
  QLabel* message_;
  QScrollArea* scroll_;
  QWidget* controls_;
  QVBoxLayout* rows_;
  QPointer<QWidget> settings_; // of the source
  /// Properties of the source, and who looks at them.
  std::vector<std::pair<vtkWeakPointer<vtkSMProperty>, unsigned long>> watched_;
  pqSonoCine* cine_;
  QPointer<pqSonoProbeWidget> played_; // that its loop moves
  pqSonoPath* path_;
  pqSonoBeat* beat_;
  QString folder_;                 // where pictures were stored last
  std::vector<double> firstAxial_; // before the other plane was asked for
  std::vector<double> firstLateral_;
};
