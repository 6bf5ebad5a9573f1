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

/// Shows a needle that is dragged in the pictures that have it among their targets, as pictures of a moving probe; when
/// it rests, it is as if its ends had been typed and applied. Unless something else waits for Apply. A frozen picture
/// stays as it is.
class pqSonoNeedleFollow : public QObject
{
  Q_OBJECT

public:
  explicit pqSonoNeedleFollow(QObject* parent = nullptr);
  ~pqSonoNeedleFollow() override;

private:
  using Ends = std::array<std::array<double, 3>, 2>;

  bool begin();
  void follow();
  void rest();
  void push(const Ends& ends, bool preview);
  Ends endsOfWidget() const;

  QTimer soon_; // once for all that a hand does meanwhile
  QTimer rest_;
  QPointer<pqPropertiesPanel> panel_;
  QPointer<pqPipelineSource> needle_;             // while it moves
  QPointer<pqInteractivePropertyWidget> handles_; // of it
  QList<QPointer<pqPipelineSource>> pictures_;    // that show it
  Ends before_{};
  std::unique_ptr<SonoMovingViews> shown_;
};

#endif
