#ifndef pqSonoThumbnails_h
#define pqSonoThumbnails_h

#include "SonoWindows.h"

#include <QObject>
#include <QPixmap>
#include <QSize>
#include <QString>
#include <QTimer>

#include <map>
#include <vector>

class vtkSMProxy;
class vtkSMSourceProxy;

/// Small pictures of what a probe sees from places on the skin, each made while nothing else is done: a preview of few
/// lines and paths, of the anatomy, the tissues and the gain of a Simulate Ultrasound. Those of an anatomy are kept.
class pqSonoThumbnails : public QObject
{
  Q_OBJECT

public:
  explicit pqSonoThumbnails(vtkSMProxy* ultrasound, QObject* parent = nullptr);

  static constexpr QSize size{ 80, 60 };

  /// Makes those of these places, which takes the place of what was begun before.
  void begin(const std::vector<SonoWindow>& places);

Q_SIGNALS:
  /// Of a place, by its number; begin() itself emits it for those that are kept.
  void made(int place, const QPixmap& picture);

private Q_SLOTS:
  void makeNext();
  void forget();

private:
  QString key(const SonoWindow& place) const;
  QPixmap make(const SonoWindow& place) const;

  vtkSMProxy* Ultrasound;
  std::vector<SonoWindow> Places;
  std::vector<int> Missing; // of them
  std::map<QString, QPixmap> Kept;
  QTimer Idle;
};

#endif
