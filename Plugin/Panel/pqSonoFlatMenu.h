#ifndef pqSonoFlatMenu_h
#define pqSonoFlatMenu_h

#include <QToolButton>

#include <functional>

class pqRenderView;
class QAction;

/// A button of the toolbar "Ultrasound" with a menu of what a scanner has beside its picture: text, outlines of labels,
/// calipers and a split screen. They go to the flat view that is active, or else to the first one.
class pqSonoFlatMenu : public QToolButton
{
  Q_OBJECT

public:
  explicit pqSonoFlatMenu(QWidget* parent = nullptr);

private:
  QAction* add(const char* name, const QString& words, const QString& tip, const std::function<void()>& act);
  void update();
  void toggle(const char* kind, const QString& step);
  void measure(int kind, const QString& step);
  void annotate();
  void measureVentricle();
  void split();
  void showMMode();

  QAction* text_;
  QAction* labels_;
  QAction* mMode_;
};

#endif
