#ifndef pqSonoDelete_h
#define pqSonoDelete_h

#include <QObject>
#include <QPointer>

class QAbstractButton;

/// Greys the properties panel's Delete while anything depends on any output of the source that is shown there, as the
/// menu's Delete is, and has Delete Downstream Pipeline delete those that depend on others first, so that undo finds
/// what they depend on. ParaView 5.11 looks in both for those that depend on the first output alone.
class pqSonoDelete : public QObject
{
  Q_OBJECT

public:
  explicit pqSonoDelete(QObject* parent = nullptr);

protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

private:
  void watch();
  void look();
  static void deleteTree();

  QPointer<QAbstractButton> button_;
  QString tip_; ///< ParaView's own
};

#endif
