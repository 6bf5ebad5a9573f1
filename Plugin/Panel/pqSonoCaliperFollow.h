#ifndef pqSonoCaliperFollow_h
#define pqSonoCaliperFollow_h

#include <QObject>
#include <QTimer>

/// Applies a caliper's points while they are dragged, so that the value follows the hand, unless something else waits
/// for Apply.
class pqSonoCaliperFollow : public QObject
{
  Q_OBJECT

public:
  explicit pqSonoCaliperFollow(QObject* parent = nullptr);

private:
  void follow();

  QTimer soon_; // once for all that a hand does meanwhile
};

#endif
