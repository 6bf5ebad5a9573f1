#ifndef pqSonoLink_h
#define pqSonoLink_h

#include <QList>
#include <QObject>
#include <QPointer>
#include <QString>
#include <QTimer>

#include <memory>

class SonoMovingViews;
class pqPipelineSource;
class vtkSMProxy;

/// Moves a probe to where the client of a Live Link says that it is: the one that the link's image was made with. While
/// poses come pictures are coarse, as when it is moved by hand, and of those that came meanwhile only the newest
/// counts.
class pqSonoLink : public QObject
{
  Q_OBJECT

public:
  explicit pqSonoLink(QObject* parent = nullptr);
  ~pqSonoLink() override;

  /// ParaView calls these when the plugin is loaded and when it closes.
  void startup();
  void shutdown();

private:
  void add(pqPipelineSource* source);
  void look();
  void say();
  bool take(pqPipelineSource* link);
  void rest();

  struct Known
  {
    QPointer<pqPipelineSource> link;
    int count = 0;  ///< of the poses that were taken
    QString status; ///< that was said last
  };
  QList<Known> Links;
  QTimer Watch;                           // while there are links
  QTimer Listen;                          // as well, to tell of clients
  QTimer Rest;                            // after the last pose
  QPointer<pqPipelineSource> Probe;       // that moves
  std::unique_ptr<SonoMovingViews> Shown; // while it does
};

#endif
