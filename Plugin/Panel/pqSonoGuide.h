#ifndef pqSonoGuide_h
#define pqSonoGuide_h

#include "SonoWindows.h"

#include <QObject>
#include <QPointer>
#include <QString>
#include <QTimer>

#include <optional>

class pqRenderView;
class vtkSMProxy;

/// Guides a hand to a place on the skin: in the views that show a Simulate Ultrasound it writes how far the probe is
/// from there and which way to slide, tilt, rock and rotate it, and when it has arrived, while the probe is moved.
class pqSonoGuide : public QObject
{
  Q_OBJECT

public:
  /// The pose is that of the widget's proxy, which has it before anything is scanned.
  pqSonoGuide(vtkSMProxy* ultrasound, vtkSMProxy* widget, QObject* parent = nullptr);
  ~pqSonoGuide() override;

  /// To there from now on.
  void guideTo(const SonoWindow& goal);
  /// Nowhere.
  void stop();

private Q_SLOTS:
  void look();

private:
  Q_DISABLE_COPY(pqSonoGuide)

  QString words() const;

  vtkSMProxy* Ultrasound;
  vtkSMProxy* Widget;
  std::optional<SonoWindow> Goal;
  QTimer Soon; // once for all properties of a movement
};

#endif
