#ifndef pqSonoErrorEye_h
#define pqSonoErrorEye_h

#include <QObject>

class pqDataRepresentation;
class pqRepresentation;
class pqView;

/// What the eye of Simulate Ultrasound's Error Map shows: in the body the map in place of the image, which lies in the
/// same plane, and the image again when it is closed; in a flat view the flat image in the map's colours, and in grey
/// again at the next click. The map is made when it is asked for so.
class pqSonoErrorEye : public QObject
{
  Q_OBJECT

public:
  explicit pqSonoErrorEye(QObject* parent = nullptr);

  /// ParaView calls these when the plugin is loaded and when it closes.
  void startup();
  void shutdown() {}

private:
  void watch(pqView* view);
  void changed(pqView* view, pqRepresentation* shown);
  void look(pqView* view, pqDataRepresentation* shown);

  bool isLooking_ = false;
};

#endif
