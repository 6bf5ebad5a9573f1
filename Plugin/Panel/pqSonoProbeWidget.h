#ifndef pqSonoProbeWidget_h
#define pqSonoProbeWidget_h

#include "SonoAhead.h"
#include "SonoRefining.h"
#include "SonoShownSurfaces.h"
#include "SonoWindows.h"

#include "pqInteractivePropertyWidget.h"

#include <QPair>
#include <QTimer>

#include <array>
#include <memory>

class QCheckBox;
class QDoubleSpinBox;
class QGridLayout;
class QLabel;
class SonoHeldPanels;
class SonoMovingViews;
class vtkSMPropertyGroup;
class vtkSonoProbeRepresentation;

/**
 * The panel of a probe's pose, with vtkSonoProbeWidget in the view: panel_widget="SonoProbe" of a property group with
 * the functions PositionMm, Axial and Lateral, and optionally DepthMm. The layout of the scan lines is taken from the
 * properties of the same proxy that are named as vtkSonoProbeSource's, so that the fan follows them.
 *
 * "Live" needs no Apply: while the probe moves, its pose and Preview = 1 go to the proxy and the views show what comes
 * of it; when it has rested for a moment, the pose is set once more with Preview = 0, as one step of undo and of the
 * trace. With a target error the picture then gets better while it is looked at (SonoRefining).
 */
class pqSonoProbeWidget : public pqInteractivePropertyWidget
{
  Q_OBJECT
  typedef pqInteractivePropertyWidget Superclass;

public:
  pqSonoProbeWidget(vtkSMProxy* proxy, vtkSMPropertyGroup* group, QWidget* parent = nullptr);
  ~pqSonoProbeWidget() override;

  ///@{
  /// The probe is shown while its source is selected. (ParaView 5.11 hides it with the panel as well, and then forgets
  /// that it was shown when another source is selected in between.)
  void hideEvent(QHideEvent*) override {}
  void showEvent(QShowEvent*) override {}
  ///@}

  void setView(pqView* view) override;

  ///@{
  /// Turns the probe about its axis, or has it stand elsewhere, as by hand; "Live" shows it even where it is frozen.
  void turn(double degrees);
  void goTo(const SonoWindow& place);
  ///@}

  /// Where it stands by now, before anything is scanned: position, axial, lateral.
  std::array<double, 9> place() const;
  /// While something else moves it, or its anatomy, it does not rest, and its pictures stay those of a moving probe.
  void hold(bool held);
  /// Whether it scans without Apply.
  bool isLive() const;
  /// What to tell a person who needs that.
  static QString tickLive();
  /// A picture on the way of where it stands, while it is held: of another moment.
  void showAgain();

Q_SIGNALS:
  void moved();

protected Q_SLOTS:
  void placeWidget() override {}

private Q_SLOTS:
  void start();
  void grip();
  void move();
  void showMoving();
  void rest();
  void prepare();
  void snap();
  void resetPose();
  void stand(const SonoWindow& window);

private:
  Q_DISABLE_COPY(pqSonoProbeWidget)

  void addRow(QGridLayout* grid, const char* function);
  void addTurn(QGridLayout* grid, int row, const QString& name, const QString& toolTip,
               void (vtkSonoProbeRepresentation::*turn)(double));
  void finish();
  void showMoved();
  void takePose();
  void findSkin();
  vtkSonoProbeRepresentation* probe() const;
  bool isUltrasound() const;
  bool mayScan() const;
  QList<QPair<QString, QVector<double>>> pose() const;
  void push(const QList<QPair<QString, QVector<double>>>& pose, bool preview);
  void showMessage();
  void showMessage(const QString& message);

  static const std::array<const char*, 4> PoseFunctions;

  QDoubleSpinBox* Step;
  QCheckBox* Live;
  QLabel* Message;
  QTimer Frame; // fires when there is nothing else to do
  QTimer Look;  // fires while a picture is computed that is to be drawn
  QTimer Rest;
  QTimer Prepare; // fires when the view has not been drawn for a moment
  bool Moving = false;
  bool Asked = false; // by turn or goTo, until it rests
  bool Held = false;
  bool IsOtherMoment = false; // than when the anatomy was drawn
  bool WasApplied = false;
  QList<QPair<QString, QVector<double>>> PoseBefore;
  std::unique_ptr<SonoMovingViews> Shown; // from the first picture on the way until the probe rests
  std::unique_ptr<SonoHeldPanels> Panels; // while a mouse drags it
  SonoShownSurfaces Surfaces;
  SonoAhead Ahead;
  SonoRefining Refining;
};

#endif
