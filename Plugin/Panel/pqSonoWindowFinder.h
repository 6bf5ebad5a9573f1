#ifndef pqSonoWindowFinder_h
#define pqSonoWindowFinder_h

#include "SonoWindows.h"

#include <QWidget>

#include <vector>

class QCheckBox;
class QComboBox;
class pqSonoGuide;
class pqSonoThumbnails;
class vtkSMProxy;

/// The part of a probe's panel that looks for places on the skin: from which an organ is seen (a name, a button), or of
/// standard views (another button), and what was found to choose from.
class pqSonoWindowFinder : public QWidget
{
  Q_OBJECT

public:
  /// Of a Simulate Ultrasound, whose probe the widget's proxy moves.
  pqSonoWindowFinder(vtkSMProxy* ultrasound, vtkSMProxy* widget, QWidget* parent = nullptr);

Q_SIGNALS:
  /// To go there.
  void chosen(const SonoWindow& window);
  /// What a person should know, one sentence.
  void said(const QString& sentence);

private:
  Q_DISABLE_COPY(pqSonoWindowFinder)

  void find();
  void findViews();
  void offer(SonoWindows found, bool areRanked);
  void choose(int candidate);

  vtkSMProxy* Ultrasound;
  QComboBox* Target;
  QComboBox* Candidate;
  QCheckBox* IsGuided; // instead of going there
  pqSonoGuide* Guide;
  pqSonoThumbnails* Pictures;
  std::vector<SonoWindow> Windows;
};

#endif
