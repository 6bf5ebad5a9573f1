#ifndef pqSonoLostViews_h
#define pqSonoLostViews_h

#include <QObject>

/// Has Apply pass over views that have no widget any more, since a script, or an undo, took their layout away. ParaView
/// 5.11 asks each view that it brought up to date whether its widget is to be seen, and ends there.
class pqSonoLostViews : public QObject
{
  Q_OBJECT

public:
  explicit pqSonoLostViews(QObject* parent = nullptr);

private:
  void listen();
};

#endif
