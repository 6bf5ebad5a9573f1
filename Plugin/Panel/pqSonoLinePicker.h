#ifndef pqSonoLinePicker_h
#define pqSonoLinePicker_h

#include <QObject>

class pqView;
class vtkObject;

/// In every render view: a plain click on an ultrasound image, pressed and released at the same place, chooses the scan
/// line there for the A-Line that plots it. A drag stays what it was, and a click that a widget takes is the widget's.
class pqSonoLinePicker : public QObject
{
  Q_OBJECT

public:
  explicit pqSonoLinePicker(QObject* parent = nullptr);

  /// ParaView calls these when the plugin is loaded and when it closes.
  void startup();
  void shutdown() {}

private:
  void watch(pqView* view);
  void press(vtkObject* interactor);
  void release(vtkObject* interactor, pqView* view);

  int pressedAt_[2] = { -1000, -1000 }; // nowhere
};

#endif
