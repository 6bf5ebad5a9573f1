#ifndef pqSonoNeedleFollow_h
#define pqSonoNeedleFollow_h

#include <QList>
#include <QObject>
#include <QPointer>
#include <QTimer>

#include <array>
#include <memory>

class SonoMovingViews;
class pqInteractivePropertyWidget;
class pqPipelineSource;
class pqPropertiesPanel;

/// Shows a needle that is dragged by its handles in the pictures that have it among their targets, as pictures of a
/// moving probe; when it rests, it is as if its ends had been typed and applied. It waits for Apply, as ever, where
/// something else does, where one of those pictures is frozen, was stopped or is not live, and where another filter
/// takes it as well.
class pqSonoNeedleFollow : public QObject
{
  Q_OBJECT

public:
  explicit pqSonoNeedleFollow(QObject* parent = nullptr);
  ~pqSonoNeedleFollow() override;

private Q_SLOTS:
  void grip();
  void follow();
  void finish();

private:
  using Ends = std::array<std::array<double, 3>, 2>;

  void watch();
  void rest();
  bool mayFollow() const;
  void setPreview(bool preview);
  void setEnds(const Ends& ends);
  Ends endsOfWidget() const;

  QTimer soon_; // once for all that a hand does meanwhile
  QTimer rest_;
  QPointer<pqPropertiesPanel> panel_;
  QPointer<pqPipelineSource> needle_;             // whose handles are watched
  QPointer<pqInteractivePropertyWidget> handles_; // these
  bool isMoving_ = false;                         // and has not come to rest
  QList<QPointer<pqPipelineSource>> pictures_;    // that show it while it moves
  Ends before_{};
  std::unique_ptr<SonoMovingViews> shown_;
};

#endif
