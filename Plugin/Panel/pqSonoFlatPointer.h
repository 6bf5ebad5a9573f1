#ifndef pqSonoFlatPointer_h
#define pqSonoFlatPointer_h

#include "vtkSmartPointer.h"

#include <QObject>

class pqRenderView;
class pqView;
class QLabel;
class vtkSMSourceProxy;

/// Says in a corner of a flat view what it shows under the pointer: structure, tissue, depth and grey level.
class pqSonoFlatPointer : public QObject
{
  Q_OBJECT

public:
  explicit pqSonoFlatPointer(QObject* parent = nullptr);
  ~pqSonoFlatPointer() override;

  /// ParaView calls these when the plugin is loaded and when it closes.
  void startup();
  void shutdown();

private:
  void watch(pqView* view);
  void follow(pqRenderView* view);
  QString sentenceAt(pqRenderView* view);

  vtkSmartPointer<vtkSMSourceProxy> pixel_; // reads the image that was followed last
};

#endif
