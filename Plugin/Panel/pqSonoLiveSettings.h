#ifndef pqSonoLiveSettings_h
#define pqSonoLiveSettings_h

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>

#include <functional>
#include <map>
#include <memory>
#include <string>

class SonoMovingViews;
class vtkSMProxy;

/**
 * What "Live" does with a probe's settings beside its pose: those of the display (gain, dynamic range, TGC, grey map
 * and all else behind the RF lines) are shown with each step of a slider, and when they have rested for a moment, they
 * are set once more as one step of undo and of the trace. What is scanned anew (depth, sector, frequency, focus, lines,
 * a preset, the target error) is scanned when it has rested and no mouse button is held, one step as well. What else
 * waits for Apply goes on waiting.
 */
class pqSonoLiveSettings : public QObject
{
  Q_OBJECT

public:
  /// `isLive`: whether nothing waits. `mayScan`: whether lines are scanned meanwhile, as by a probe that rests and is
  /// not frozen. `beforePicture` is called before a picture in full is made.
  pqSonoLiveSettings(vtkSMProxy* proxy, std::function<bool()> isLive, std::function<bool()> mayScan,
                     std::function<void()> beforePicture, QObject* parent);
  ~pqSonoLiveSettings() override;

private Q_SLOTS:
  void displayChanged();
  void scanChanged();

private:
  Q_DISABLE_COPY(pqSonoLiveSettings)

  struct Setting
  {
    double number = 0.0;
    std::string text;
  };
  using Settings = std::map<std::string, Setting>;

  bool isLive() const;
  void begin();
  void askForStep();
  /// Of these properties, what waits for Apply.
  Settings waiting(const Settings& among) const;
  Settings applied(const Settings& among) const;
  void set(const Settings& settings);
  void showStep();
  void rest();

  vtkSMProxy* Proxy;
  std::function<bool()> IsLive;
  std::function<bool()> MayScan;
  std::function<void()> BeforePicture;
  Settings Display;        // its values do not count
  Settings Scan;           // nor do these
  QTimer Frame;            // fires when there is nothing else to do
  bool IsAsked = false;    // for a step before all else
  QElapsedTimer SinceStep; // was shown
  QTimer Rest;
  bool NothingWaits = false; // beside
  bool IsSetting = false;
  Settings Before;                        // of what was changed since it last rested
  std::unique_ptr<SonoMovingViews> Shown; // from the first step until it rests
};

#endif
