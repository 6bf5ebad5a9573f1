#ifndef pqSonoUndoing_h
#define pqSonoUndoing_h

#include <QObject>

/// Has ParaView's Auto Apply wait while something is undone or done again. ParaView 5.11 lets events through while a
/// layout is put back; Auto Apply, due by then, looks at views that have no widget yet, and ends the program.
class pqSonoUndoing : public QObject
{
  Q_OBJECT

public:
  explicit pqSonoUndoing(QObject* parent = nullptr);

protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
};

#endif
