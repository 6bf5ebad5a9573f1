#ifndef pqSonoFlatFit_h
#define pqSonoFlatFit_h

#include <QMap>
#include <QObject>

class pqRenderView;
class pqView;

/// Keeps the flat image as large as its view allows when its depth, its probe or the view's size change. Whoever zooms
/// or moves it keeps that, until the camera is reset.
class pqSonoFlatFit : public QObject
{
  Q_OBJECT

public:
  explicit pqSonoFlatFit(QObject* parent = nullptr);

  /// ParaView calls these when the plugin is loaded and when it closes.
  void startup();
  void shutdown() {}

  /// How a camera looks at a flat image: at what, in mm, and half the height that it sees.
  struct Sight
  {
    double x = 0.0;
    double y = 0.0;
    double halfHeight = 0.0;
  };

private:
  void watch(pqView* view);
  void look(pqRenderView* view);
  void fit(pqRenderView* view);

  struct Known
  {
    bool isOurs = false;   ///< nobody has looked closer since
    bool wasReset = false; ///< since it was drawn last
    Sight left;            ///< as it was drawn last
  };
  QMap<pqView*, Known> Views;
};

#endif
