#ifndef pqSonoLoading_h
#define pqSonoLoading_h

#include <QObject>
#include <QPointer>

#include <vector>

class QWidget;

/// Keeps views from being painted while a state file is being loaded. ParaView 5.11 paints a tab as soon as it appears,
/// without the data, which an image's slice calls an error. What was not painted is drawn once the state is there.
class pqSonoLoading : public QObject
{
  Q_OBJECT

public:
  explicit pqSonoLoading(QObject* parent = nullptr);

protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

private:
  void draw();

  std::vector<QPointer<QWidget>> unpainted_;
};

#endif
